// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/weld.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace spherule::internal {
namespace {

using Key = std::array<std::uint64_t, 3>;

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = 0x9E3779B97F4A7C15u;
    for (const std::uint64_t word : key) {
      hash = (hash ^ word) * 0xBF58476D1CE4E5B9u;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh) {
  TriangleMesh result;
  result.vertex_error = mesh.vertex_error;
  result.triangles.reserve(mesh.triangles.size());
  std::unordered_map<Key, int, KeyHash> index_of;
  index_of.reserve(mesh.vertices.size());
  std::vector<int> new_index(mesh.vertices.size(), -1);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    Eigen::Vector3i welded;
    for (int k = 0; k < 3; ++k) {
      const auto old = static_cast<std::size_t>(triangle[k]);
      if (new_index[old] < 0) {
        // Adding zero turns a negative zero into a positive one and changes nothing else.
        const Eigen::Vector3d v = mesh.vertices[old] + Eigen::Vector3d::Zero();
        const Key key{std::bit_cast<std::uint64_t>(v.x()), std::bit_cast<std::uint64_t>(v.y()),
                      std::bit_cast<std::uint64_t>(v.z())};
        const auto [entry, is_new] =
            index_of.try_emplace(key, static_cast<int>(result.vertices.size()));
        if (is_new) result.vertices.push_back(v);
        new_index[old] = entry->second;
      }
      welded[k] = new_index[old];
    }
    result.triangles.push_back(welded);
  }
  return result;
}

}  // namespace spherule::internal
