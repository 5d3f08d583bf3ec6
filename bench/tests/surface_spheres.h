// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "spheretree/build.h"

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace spherule::test {

// A sphere about the box of every triangle: covers the surface, without any fit.
inline std::shared_ptr<const SphereTree> surface_spheres(const TriangleMesh& mesh) {
  std::vector<Sphere> spheres;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < 3; ++i) box.extend(mesh.vertices[static_cast<std::size_t>(t[i])]);
    spheres.push_back({box.center(), 0.5 * box.diagonal().norm() * (1.0 + 1e-12)});
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

inline void add_surface_spheres(Workload& cell) {
  for (Body& body : cell.bodies) body.part.tree = surface_spheres(body.part.mesh);
  for (Obstacle& obstacle : cell.obstacles) {
    obstacle.part.tree = surface_spheres(obstacle.part.mesh);
  }
}

}  // namespace spherule::test
