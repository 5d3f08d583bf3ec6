// SPDX-License-Identifier: BSD-3-Clause
#include "cli/cad/cad_message.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace spherule {
namespace {

using Message = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

// The coordinates of points, or the indices of triangles, as they stand in memory: both ends run on
// the same machine.
template <typename Row>
Message rows(const std::vector<Row>& values) {
  static_assert(sizeof(Row) == 3 * sizeof(typename Row::Scalar));
  Bytes bytes(values.size() * sizeof(Row));
  if (!values.empty()) std::memcpy(bytes.data(), values.data()->data(), bytes.size());
  return Message::binary(std::move(bytes));
}

template <typename Row>
std::vector<Row> rows_of(const Message& message) {
  const Bytes& bytes = message.get_binary();
  if (bytes.size() % sizeof(Row) != 0) throw std::runtime_error("rows are not whole");
  std::vector<Row> values(bytes.size() / sizeof(Row));
  if (!values.empty()) std::memcpy(values.data()->data(), bytes.data(), bytes.size());
  return values;
}

Message to_message(const CadPart& part) {
  Message unproved = Message::array();
  for (const UnprovedFace& face : part.unproved) unproved.push_back({face.name, face.reason});
  return {{"vertices", rows(part.mesh.vertices)},
          {"triangles", rows(part.mesh.triangles)},
          {"vertex_error", part.mesh.vertex_error},
          {"chord_error", part.chord_error},
          {"asked", part.asked},
          {"reached", part.reached},
          {"tolerance", part.tolerance},
          {"proved", part.proved},
          {"unproved", std::move(unproved)},
          {"faces", part.faces},
          {"free_edges", part.free_edges},
          {"stated_unit", part.stated_unit}};
}

CadPart part_of(const Message& message) {
  CadPart part;
  part.mesh.vertices = rows_of<Eigen::Vector3d>(message.at("vertices"));
  part.mesh.triangles = rows_of<Eigen::Vector3i>(message.at("triangles"));
  part.mesh.vertex_error = message.at("vertex_error").get<double>();
  part.chord_error = message.at("chord_error").get<double>();
  part.asked = message.at("asked").get<double>();
  part.reached = message.at("reached").get<double>();
  part.tolerance = message.at("tolerance").get<double>();
  part.proved = message.at("proved").get<bool>();
  for (const Message& face : message.at("unproved")) {
    part.unproved.push_back({face.at(0).get<std::string>(), face.at(1).get<std::string>()});
  }
  part.faces = message.at("faces").get<std::size_t>();
  part.free_edges = message.at("free_edges").get<std::size_t>();
  part.stated_unit = message.at("stated_unit").get<std::string>();
  return part;
}

Message to_message(const BodyCopy& copy) {
  const Eigen::Quaterniond q = copy.pose.rotation();
  const Eigen::Vector3d& t = copy.pose.translation();
  return {{"of", copy.of},
          {"rotation", {q.w(), q.x(), q.y(), q.z()}},
          {"translation", {t.x(), t.y(), t.z()}}};
}

BodyCopy copy_of(const Message& message) {
  const auto q = message.at("rotation").get<std::vector<double>>();
  const auto t = message.at("translation").get<std::vector<double>>();
  return {.of = message.at("of").get<std::size_t>(),
          .pose = Pose(Eigen::Quaterniond(q.at(0), q.at(1), q.at(2), q.at(3)),
                       {t.at(0), t.at(1), t.at(2)})};
}

std::string to_bytes(const Message& message) {
  std::string bytes;
  Message::to_cbor(message, bytes);
  return bytes;
}

}  // namespace

std::string packed(std::span<const CadBody> bodies) {
  Message message = Message::array();
  for (const CadBody& body : bodies) {
    Message one = {{"name", body.name}, {"part", to_message(body.part)}};
    if (body.copy) one["copy"] = to_message(*body.copy);
    message.push_back(std::move(one));
  }
  return to_bytes({{"bodies", std::move(message)}});
}

std::string packed_error(const std::string& subject, const std::string& reason) {
  return to_bytes({{"subject", subject}, {"reason", reason}});
}

std::vector<CadBody> unpacked(std::string_view bytes) {
  const Message message = Message::from_cbor(bytes.begin(), bytes.end());
  if (message.contains("reason")) {
    throw Error(message.at("subject").get<std::string>(), message.at("reason").get<std::string>());
  }
  std::vector<CadBody> bodies;
  for (const Message& one : message.at("bodies")) {
    CadBody body{.name = one.at("name").get<std::string>(), .part = part_of(one.at("part"))};
    if (one.contains("copy")) body.copy = copy_of(one.at("copy"));
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace spherule
