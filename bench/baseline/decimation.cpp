// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/mesh_methods.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <meshoptimizer.h>
#include <vector>

namespace spherule {
namespace {

// The library's limit of the error is a float relative to the extent; beyond the extent it limits
// nothing.
constexpr double kNoLimit = 1e6;

void check(const DecimationOptions& options) {
  if (options.target_triangles == 0) throw Error("target triangles", "must be positive");
  if (!(options.max_error >= 0.0)) throw Error("max error", "must not be negative");
}

std::vector<unsigned int> indices_of(const TriangleMesh& mesh) {
  std::vector<unsigned int> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) indices.push_back(static_cast<unsigned int>(t[k]));
  }
  return indices;
}

// The triangles of `indices` with the vertices they use, in the order of the original's.
TriangleMesh compacted(const TriangleMesh& mesh, const std::vector<unsigned int>& indices) {
  std::vector<int> place(mesh.vertices.size(), -1);
  for (const unsigned int i : indices) place[i] = 0;
  TriangleMesh result;
  result.vertex_error = mesh.vertex_error;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] < 0) continue;
    place[i] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[i]);
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Eigen::Vector3i t(place[indices[i]], place[indices[i + 1]], place[indices[i + 2]]);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.triangles.push_back(t);
  }
  return result;
}

}  // namespace

Decimation decimate(const TriangleMesh& mesh, const DecimationOptions& options) {
  validate(mesh, "mesh");
  check(options);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  const double extent = box.sizes().maxCoeff();
  if (!(extent > 0.0)) throw Error("mesh", "has no extent");

  // About the centre and by the extent, so that floats lose as little as they can.
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const Eigen::Vector3f p = ((v - box.center()) / extent).cast<float>();
    positions.insert(positions.end(), p.begin(), p.end());
  }
  const std::vector<unsigned int> indices = indices_of(mesh);
  constexpr std::size_t kStride = 3 * sizeof(float);
  const double scale =
      extent * meshopt_simplifyScale(positions.data(), mesh.vertices.size(), kStride);
  const double limit = std::min(options.max_error / scale, kNoLimit);
  const std::size_t target = 3 * std::min(options.target_triangles, mesh.triangles.size());
  std::vector<unsigned int> kept(indices.size());
  float error = 0.0F;
  kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                               mesh.vertices.size(), kStride, target, static_cast<float>(limit), 0,
                               &error));

  Decimation result;
  result.mesh = compacted(mesh, kept);
  if (result.mesh.triangles.empty()) throw Error("mesh", "nothing of it is left: raise the target");
  result.estimated_error = scale * static_cast<double>(error);
  if (options.measure) result.deviation = measure_deviation(mesh, result.mesh, *options.measure);
  return result;
}

}  // namespace spherule
