// SPDX-License-Identifier: BSD-3-Clause
#include "tests/collide/tetrahedra.h"

#include "spheretree/build.h"

#include <vector>

namespace spherule::test {

std::shared_ptr<const CoveredMesh> covered_tetrahedron(SceneRandom& random, double size) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  for (Eigen::Vector3d& v : mesh.vertices) v = size * (v - Eigen::Vector3d(0.25, 0.25, 0.25));
  std::vector<Sphere> spheres = {{Eigen::Vector3d::Zero(), 0.9 * size}};
  for (int i = 0; i < 20; ++i) {
    spheres.push_back({random.point(0.5 * size), random.uniform(0.0, 0.3 * size)});
  }
  return std::make_shared<const CoveredMesh>(
      mesh, std::make_shared<const SphereTree>(build_tree(spheres)));
}

std::shared_ptr<const CoveredMesh> covered_surface(const TriangleMesh& mesh) {
  return std::make_shared<const CoveredMesh>(
      mesh, std::make_shared<const SphereTree>(MeshTree(mesh).tree()));
}

std::shared_ptr<const SphereTree> cover_of(const std::shared_ptr<const CoveredMesh>& mesh) {
  return {mesh, &mesh->cover()};
}

}  // namespace spherule::test
