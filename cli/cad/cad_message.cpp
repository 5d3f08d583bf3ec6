// SPDX-License-Identifier: BSD-3-Clause
#include "cli/cad/cad_message.h"

#include "base/error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace spherule {
namespace {

using Message = nlohmann::json;

// Values as they stand in memory: both ends run on the same machine.
template <typename Row>
Message rows(std::span<const Row> values) {
  std::vector<std::uint8_t> bytes(values.size_bytes());
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return Message::binary(std::move(bytes));
}

template <typename Row>
void get_rows(const Message& message, std::vector<Row>& values) {
  const std::vector<std::uint8_t>& bytes = message.get_binary();
  if (bytes.size() % sizeof(Row) != 0) throw std::runtime_error("rows are not whole");
  values.resize(bytes.size() / sizeof(Row));
  if (!values.empty()) std::memcpy(values.data()->data(), bytes.data(), bytes.size());
}

}  // namespace

// Found by nlohmann-json, by their names.
static void to_json(Message& message, const TriangleMesh& mesh) {
  message = {{"vertices", rows(std::span(mesh.vertices))},
             {"triangles", rows(std::span(mesh.triangles))},
             {"vertex_error", mesh.vertex_error}};
}
static void from_json(const Message& message, TriangleMesh& mesh) {
  get_rows(message.at("vertices"), mesh.vertices);
  get_rows(message.at("triangles"), mesh.triangles);
  message.at("vertex_error").get_to(mesh.vertex_error);
}
static void to_json(Message& message, const BodyCopy& copy) {
  const Eigen::Vector4d q = copy.pose.rotation().coeffs();
  const Eigen::Vector3d& t = copy.pose.translation();
  message = {copy.of, q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}
static void from_json(const Message& message, BodyCopy& copy) {
  const auto [of, x, y, z, w, tx, ty, tz] =
      message
          .get<std::tuple<std::size_t, double, double, double, double, double, double, double>>();
  copy = {of, Pose(Eigen::Quaterniond(w, x, y, z), {tx, ty, tz})};
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(UnprovedFace, name, reason)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CadPart, mesh, chord_error, asked, reached, tolerance, proved,
                                   unproved, faces, free_edges, stated_unit)

namespace {

std::string to_bytes(const Message& message) {
  std::string bytes;
  Message::to_cbor(message, bytes);
  return bytes;
}

}  // namespace

std::string packed(std::span<const CadBody> bodies) {
  Message message = Message::array();
  for (const CadBody& body : bodies) {
    Message& one = message.emplace_back(Message{{"name", body.name}, {"part", body.part}});
    if (body.copy) one["copy"] = *body.copy;
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
    CadBody body{.name = one.at("name").get<std::string>(), .part = one.at("part").get<CadPart>()};
    if (one.contains("copy")) body.copy = one.at("copy").get<BodyCopy>();
    bodies.push_back(std::move(body));
  }
  return bodies;
}

}  // namespace spherule
