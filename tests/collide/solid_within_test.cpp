// SPDX-License-Identifier: BSD-3-Clause
// Two meshes of needles within a clearance, against 100 digits, and the boxes that cut it short.

#include "collide/solids/solid_within.h"

#include "collide/meshes/mesh_inside.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/scene_random.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace spherule::test::solid_within_test {
namespace {

using Eigen::Vector3d;

// Long thin triangles, half of them along an axis of their frame, as strips of a tube are.
TriangleMesh needles(SceneRandom& random, int count, double size) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vector3d start = random.point(size);
    Vector3d along = random.point(size);
    if (i % 2 == 0) along = size * Vector3d::Unit(random.whole(0, 2));
    const Vector3d wide = random.point(1e-2 * size);
    const int first = static_cast<int>(mesh.vertices.size());
    for (const Vector3d& corner : {start, Vector3d(start + along), Vector3d(start + wide)}) {
      mesh.vertices.push_back(corner);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

double exact_gap_of(const MeshTree& a, const Pose& world_from_a, const MeshTree& b,
                    const Pose& world_from_b) {
  double least = std::numeric_limits<double>::infinity();
  const auto count = [](const MeshTree& mesh) {
    return static_cast<std::int32_t>(mesh.tree().spheres().size());
  };
  for (std::int32_t i = 0; i < count(a); ++i) {
    for (std::int32_t j = 0; j < count(b); ++j) {
      least = std::min(least, exact_gap(a.triangle(i), world_from_a, b.triangle(j), world_from_b));
    }
  }
  return least;
}

TEST(SolidWithin, MeshesOfNeedlesAreJudgedByTheirExactGap) {
  SceneRandom random(23);
  int apart = 0;
  for (int n = 0; n < effort(80, 8); ++n) {
    const double size = std::ldexp(1.0, random.whole(-20, 17));
    const SolidMesh a(needles(random, 14, size));
    const SolidMesh b(needles(random, 14, size));
    const Pose world_from_a = random.pose(2.0 * size);
    const Pose world_from_b = random.pose(2.0 * size);
    const double gap = exact_gap_of(a.mesh(), world_from_a, b.mesh(), world_from_b);
    const double above = std::nextafter(gap, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(within(a, world_from_a, b, world_from_b, gap == 0.0 ? 0.0 : above)) << n;
    EXPECT_EQ(within(a, world_from_a, b, world_from_b, 0.0),
              within(b, world_from_b, a, world_from_a, 0.0));
    const double below = gap - 1e-12 * size;
    if (below <= 0.0) continue;
    ++apart;
    EXPECT_FALSE(within(a, world_from_a, b, world_from_b, below)) << n;
  }
  EXPECT_GT(apart, effort(40, 3));
}

// A node's box holds the triangles of all leaves below it, and is no larger than they need.
void expect_box_of_triangles(const MeshTree& mesh, const internal::NodeBoxes& boxes,
                             std::size_t node) {
  std::vector<std::size_t> todo{node};
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  while (!todo.empty()) {
    const std::size_t at = todo.back();
    todo.pop_back();
    if (mesh.tree().is_leaf(at)) {
      for (const Vector3d& corner : mesh.triangle(mesh.tree().sphere_index(at))) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    for (std::int32_t i = 0; i < mesh.tree().child_count(at); ++i) {
      todo.push_back(static_cast<std::size_t>(mesh.tree().first_child(at) + i));
    }
  }
  const AxisAlignedBox box = boxes.box(node);
  for (int i = 0; i < 3; ++i) {
    const Real center = box.center[i], half = box.half_size[i];
    EXPECT_TRUE(center - half <= Real(low[i]) && Real(high[i]) <= center + half);
    EXPECT_LE(std::abs(box.center[i]) + box.half_size[i],
              mesh.tree().reach() * (1.0 + 0x1p-21) + 0x1p-125);
    const double farthest = std::max(std::abs(low[i]), std::abs(high[i]));
    EXPECT_LE(box.half_size[i], 0.5 * high[i] - 0.5 * low[i] + 0x1p-21 * farthest + 0x1p-125);
  }
}

TEST(NodeBoxes, HoldTheTrianglesBelowTheirNodes) {
  SceneRandom random(24);
  for (int n = 0; n < effort(60, 20); ++n) {
    const double size = std::ldexp(1.0, random.whole(n % 3 == 0 ? -500 : -20, 30));
    const MeshTree mesh(needles(random, random.whole(1, 100), size));
    const internal::NodeBoxes boxes(mesh);
    for (std::size_t node = 0; node < mesh.tree().node_count(); ++node) {
      expect_box_of_triangles(mesh, boxes, node);
    }
  }
}

}  // namespace
}  // namespace spherule::test::solid_within_test
