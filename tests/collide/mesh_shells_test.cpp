// SPDX-License-Identifier: BSD-3-Clause
// Insides of meshes whose triangles do not simply face outwards.

#include "collide/internal/mesh_shells.h"

#include "collide/internal/mesh_inside.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::MeshInside;

TriangleMesh double_sided(const TriangleMesh& mesh) {
  return joined(mesh, inverted(mesh));
}

TriangleMesh without_last(TriangleMesh mesh) {
  mesh.triangles.pop_back();
  return mesh;
}

// A triangle upright on an edge of the unit cube.
TriangleMesh flap_on_cube() {
  return {{{0, 0, 1}, {1, 0, 1}, {0.5, 0, 2}}, {{0, 1, 2}}};
}

bool contains(const TriangleMesh& mesh, const Vector3d& point) {
  return MeshInside(mesh).contains(MeshTree(mesh), point, 1e-12);
}

const Vector3d kMiddle(0.45, 0.52, 0.57);
const Vector3d kOutside(1.2, 0.5, 0.4);

void expect_solid(const TriangleMesh& mesh, bool is_closed = true) {
  const MeshInside inside(mesh);
  EXPECT_EQ(inside.is_closed(), is_closed);
  EXPECT_TRUE(inside.has_inside());
  EXPECT_TRUE(contains(mesh, kMiddle));
  EXPECT_FALSE(contains(mesh, kOutside));
}

void expect_nothing_inside(const TriangleMesh& mesh) {
  const MeshInside inside(mesh);
  EXPECT_FALSE(inside.is_closed());
  EXPECT_FALSE(inside.has_inside());
  EXPECT_FALSE(contains(mesh, kMiddle));
}

TEST(MeshShells, ADoubleSidedShellHasItsInside) {
  expect_solid(double_sided(cube_mesh()));
  expect_solid(double_sided(double_sided(cube_mesh())));
  expect_solid(joined(double_sided(cube_mesh()), cube_mesh()));
  // A collinear facet, on one edge, is a sheet.
  expect_solid(with_degenerates(double_sided(cube_mesh())), false);
  // The first of two alike facing inwards for some and outwards for the others.
  TriangleMesh mixed = double_sided(cube_mesh());
  std::rotate(mixed.triangles.begin(), mixed.triangles.begin() + 5, mixed.triangles.end());
  expect_solid(mixed);
  // One side of one triangle missing.
  expect_solid(without_last(double_sided(cube_mesh())));
}

TEST(MeshShells, ADoubleSidedSheetHasNone) {
  expect_nothing_inside(double_sided(flap_on_cube()));
  expect_nothing_inside(double_sided(open_box()));
  expect_nothing_inside(double_sided(without_last(cube_mesh())));
  expect_nothing_inside(double_sided(klein_bottle(16, 24)));
}

// The shell on whose edge it stands keeps what it encloses, however it is drawn.
TEST(MeshShells, ADoubleSidedFlapTakesNothingAway) {
  const TriangleMesh flap = double_sided(flap_on_cube());
  expect_solid(joined(cube_mesh(), flap), false);
  expect_solid(joined(double_sided(cube_mesh()), flap), false);
}

TEST(MeshShells, PartsDoNotCancelEachOther) {
  const TriangleMesh a = box_mesh({-1, -1, -1}, {1, 1, 1});
  const TriangleMesh b = inverted(box_mesh({-.7, -.8, -.9}, {1.2, 1.3, 1.4}));
  EXPECT_TRUE(MeshInside(joined(a, b)).is_closed());
  EXPECT_TRUE(contains(joined(a, b), Vector3d::Zero()));
  EXPECT_TRUE(contains(joined(double_sided(a), b), Vector3d::Zero()));
  EXPECT_TRUE(contains(joined(double_sided(a), double_sided(b)), Vector3d::Zero()));
}

// Two that overlap and have a vertex in common, or an edge.
TEST(MeshShells, NorDoPartsThatShareAVertexOrAnEdge) {
  const TriangleMesh cube = cube_mesh();
  const TriangleMesh at_vertex = {{{0, 0, 0}, {2, 0.3, 0.1}, {0.1, 2, 0.3}, {0.3, 0.1, 2}},
                                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const TriangleMesh at_edge = {{{0, 0, 0}, {1, 0, 0}, {0.1, 2, 1.2}, {0.3, 1.2, 2}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Vector3d in_both(0.4, 0.4, 0.4);
  for (const TriangleMesh& other : {at_vertex, inverted(at_vertex)}) {
    ASSERT_TRUE(contains(other, in_both));
    EXPECT_TRUE(contains(joined(cube, other), in_both));
    EXPECT_TRUE(contains(joined(double_sided(cube), double_sided(other)), in_both));
  }
  for (const TriangleMesh& other : {at_edge, inverted(at_edge)}) {
    ASSERT_TRUE(contains(other, in_both));
    EXPECT_TRUE(contains(joined(double_sided(cube), double_sided(other)), in_both));
    EXPECT_TRUE(contains(joined(double_sided(other), double_sided(cube)), in_both));
  }
}

TEST(MeshShells, HollowsAndWhatIsInThemAreInside) {
  for (const int count : {2, 3}) {
    const TriangleMesh shells = nested_shells(count);
    for (const TriangleMesh& mesh : {shells, inverted(shells), double_sided(shells)}) {
      expect_solid(mesh);
      EXPECT_TRUE(contains(mesh, {0.05, 0.5, 0.45}));
      EXPECT_TRUE(contains(mesh, {0.22, 0.5, 0.45}));
    }
  }
}

// More surfaces on the ray than are counted at a time, of which one encloses the point.
TEST(MeshShells, ManySurfacesOnOneRay) {
  const Vector3d direction = internal::kRayDirections[0];
  TriangleMesh small;
  for (int i = 1; i <= 150; ++i) {
    const Vector3d middle = kMiddle + 0.02 * i * direction;
    small = joined(small,
                   box_mesh(middle - Vector3d::Constant(2e-3), middle + Vector3d::Constant(3e-3)));
  }
  const TriangleMesh cube = cube_mesh();
  EXPECT_FALSE(contains(small, kMiddle));
  EXPECT_TRUE(contains(joined(small, cube), kMiddle));
  EXPECT_TRUE(contains(joined(cube, small), kMiddle));
  EXPECT_TRUE(contains(joined(small, inverted(joined(cube, small))), kMiddle));
  EXPECT_FALSE(contains(joined(small, cube), kOutside));
  EXPECT_FALSE(contains(joined(small, cube), kMiddle - 2.0 * direction));
}

}  // namespace
}  // namespace spherule::test
