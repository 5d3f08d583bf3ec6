// SPDX-License-Identifier: BSD-3-Clause
#include "io/collada_skin.h"

#include "io/collada_geometry.h"
#include "io/collada_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace spherule::internal {
namespace {

using Element = ColladaDocument::Element;

const Element& needed_input(const ColladaDocument& document, const Element& parent,
                            const char* semantic) {
  const Element* const found = collada_input(parent, semantic);
  if (found == nullptr) document.fail(parent, "has no input " + std::string(semantic));
  return *found;
}

void read_joints(const ColladaDocument& document, const Element& skin, ColladaSkin& result) {
  const Element& joints = document.child(skin, "joints");
  const Element& names =
      document.referred("source", needed_input(document, joints, "JOINT"), "source");
  result.are_ids = !document.children(names, "IDREF_array").empty();
  result.joints =
      document.words(document.child(names, result.are_ids ? "IDREF_array" : "Name_array"));
  const Element& matrices =
      document.referred("source", needed_input(document, joints, "INV_BIND_MATRIX"), "source");
  const ColladaValues values = collada_values(document, matrices, 16);
  if (values.count() != result.joints.size()) {
    document.fail(joints, "has not as many matrices as joints");
  }
  for (std::size_t j = 0; j < values.count(); ++j) {
    result.inverse_bind.push_back(
        collada_matrix(document, matrices, std::span(values.numbers).subspan(16 * j, 16)));
  }
}

void read_weights(const ColladaDocument& document, const Element& skin, std::size_t vertex_count,
                  ColladaSkin& result) {
  const Element& list = document.child(skin, "vertex_weights");
  const Element& joint = needed_input(document, list, "JOINT");
  const Element& weight = needed_input(document, list, "WEIGHT");
  const ColladaValues weights =
      collada_values(document, document.referred("source", weight, "source"), 1);
  std::size_t stride = 0;
  for (const Element* input = list.FirstChildElement("input"); input != nullptr;
       input = input->NextSiblingElement("input")) {
    stride = std::max(stride, document.whole_attribute(*input, "offset", 0) + 1);
  }
  const std::size_t joint_at = document.whole_attribute(joint, "offset", 0);
  const std::size_t weight_at = document.whole_attribute(weight, "offset", 0);
  const std::vector<std::int64_t> counts = document.whole_numbers(document.child(list, "vcount"));
  const std::vector<std::int64_t> indices = document.whole_numbers(document.child(list, "v"));
  if (counts.size() != vertex_count) document.fail(list, "has not a count for every vertex");
  result.weights.resize(result.joints.size() + 1);
  std::size_t at = 0;
  for (std::size_t vertex = 0; vertex < vertex_count; ++vertex) {
    const std::int64_t count = counts[vertex];
    if (count < 0 || static_cast<std::uint64_t>(count) > (indices.size() - at) / stride) {
      document.fail(list, "has fewer indices than its counts need");
    }
    double sum = 0.0;
    for (std::int64_t k = 0; k < count; ++k, at += stride) {
      const std::int64_t j = indices[at + joint_at];
      const std::int64_t w = indices[at + weight_at];
      if (j < -1 || j >= static_cast<std::int64_t>(result.joints.size()) || w < 0 ||
          w >= static_cast<std::int64_t>(weights.count())) {
        document.fail(list, "has an index that is out of range");
      }
      const double value = weights.numbers[static_cast<std::size_t>(w)];
      if (!(value >= 0.0)) document.fail(list, "has a negative weight");
      const std::size_t moved = j < 0 ? result.joints.size() : static_cast<std::size_t>(j);
      if (value > 0.0) result.weights[moved].push_back({vertex, value});
      sum += value;
    }
    if (!(std::abs(sum - 1.0) <= kWeightTolerance)) {
      document.fail(list, "has a vertex whose weights do not add up to 1");
    }
  }
  if (at != indices.size()) document.fail(list, "has more indices than its counts need");
}

}  // namespace

ColladaSkin collada_skin(const ColladaDocument& document, const Element& skin,
                         std::size_t vertex_count) {
  ColladaSkin result;
  result.bind_shape = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  if (const Element* const matrix = skin.FirstChildElement("bind_shape_matrix")) {
    result.bind_shape = collada_matrix(document, *matrix, document.numbers(*matrix));
  }
  read_joints(document, skin, result);
  read_weights(document, skin, vertex_count, result);
  return result;
}

}  // namespace spherule::internal
