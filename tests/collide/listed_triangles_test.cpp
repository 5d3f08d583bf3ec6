// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_contact.h"
#include "spheretree/build.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>

namespace spherule::test {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Vector3d;

// A triangle that touches another with a corner, so tiny that its normal underflows: a plane whose
// normal is not known keeps nothing apart.
TEST(ListedTriangles, ATriangleWithoutANormalIsNotMissed) {
  const auto covered = [](const Corners& corners, double radius) {
    TriangleMesh mesh;
    mesh.vertices.assign(corners.begin(), corners.end());
    mesh.triangles.emplace_back(0, 1, 2);
    const Sphere around{Vector3d::Zero(), radius};
    return CoveredMesh(mesh, std::make_shared<const SphereTree>(build_tree(std::span(&around, 1))));
  };
  const CoveredMesh tiny =
      covered({Vector3d::Zero(),
               {0x1.3ecbe6e51fc91p-538, 0x1.c15a47cf5c6b2p-537, -0x1.1b6007535326ap-537},
               {0x1.5d7930423d229p-537, -0x1.380a5555657e3p-539, -0x1.1ee029e7e25e5p-538}},
              1e-3);
  const CoveredMesh other = covered({Vector3d(-0x1.b8156a4p-3, 0x1.3fd9d288p-1, -0x1.a3a8fp-3),
                                     {0x1.3e8ee648p-1, -0x1.8cbe252p-2, -0x1.e0bf4ecp-4},
                                     {-0x1.a113177p-2, -0x1.e5eaffep-3, 0x1.4a044bbp-2}},
                                    2.0);
  EXPECT_TRUE(collides(tiny, Pose(), other, Pose()));
  EXPECT_TRUE(collides(other, Pose(), tiny, Pose()));
}

}  // namespace
}  // namespace spherule::test
