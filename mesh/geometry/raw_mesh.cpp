// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/geometry/raw_mesh.h"

#include "spheretree/atomic_file.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <system_error>
#include <unordered_map>

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

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void check_scale(double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw Error("scale", "must be a positive finite number, not " + std::to_string(scale));
  }
}

std::string read_regular_file(const std::filesystem::path& path) {
  const std::string subject = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw Error(subject, "no such file");
  if (error) throw Error(subject, error.message());
  if (std::filesystem::is_directory(status)) throw Error(subject, "is a directory");
  if (!std::filesystem::is_regular_file(status)) throw Error(subject, "is not a regular file");
  std::string bytes = read_file(path);
  if (bytes.empty()) throw Error(subject, "the file is empty");
  return bytes;
}

void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject) {
  if (vertex_count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(subject, "more than 2^31 vertices");
  }
  for (const std::int64_t corner : corners) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count) {
      throw Error(subject, "a face refers to vertex " + std::to_string(corner) + " (from 0) of " +
                               std::to_string(vertex_count));
    }
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[i - 1]),
                                static_cast<int>(corners[i]));
  }
}

double largest_coordinate(const TriangleMesh& mesh) {
  double largest = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    for (const double x : {v.x(), v.y(), v.z()}) {
      if (std::isnan(x)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

double rounding_distance(double largest, double relative) {
  constexpr double kRootOfThree = 1.7320508075688774;  // rounded up
  return kRootOfThree * largest * relative * (1.0 + 0x1p-50);
}

void apply_scale(TriangleMesh& mesh, double scale) {
  if (scale == 1.0) return;
  for (Eigen::Vector3d& v : mesh.vertices) v *= scale;
  mesh.vertex_error = add_up(mul_up(mesh.vertex_error, scale),
                             rounding_distance(largest_coordinate(mesh), 2.0 * kUnitRoundoff));
}

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
