// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/triangle_mesh.h"

#include "base/error.h"
#include "base/rounding.h"

#include <algorithm>
#include <cmath>

namespace spherule {

// What every reader's mesh has to pass before anything is made of it (G8).
void validate(const TriangleMesh& mesh, const std::string& subject) {
  if (mesh.triangles.empty()) throw Error(subject, "there are no triangles");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d& v = mesh.vertices[i];
    if (is_usable_point(v)) continue;
    throw Error(subject, "vertex " + std::to_string(i) + " has a coordinate that is " +
                             (v.allFinite() ? "beyond 1e15" : "not finite"));
  }
  const auto count = static_cast<int>(std::min<std::size_t>(mesh.vertices.size(), 0x7FFFFFFF));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.triangles[i].minCoeff() < 0 || mesh.triangles[i].maxCoeff() >= count) {
      throw Error(subject, "triangle " + std::to_string(i) + " refers to a vertex out of range");
    }
  }
  if (!(mesh.vertex_error >= 0.0) || !std::isfinite(mesh.vertex_error)) {
    throw Error(subject, "the vertex error must be finite and not negative");
  }
}

}  // namespace spherule
