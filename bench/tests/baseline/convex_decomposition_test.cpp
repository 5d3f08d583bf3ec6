// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/convex_decomposition.h"

#include "base/error.h"
#include "bench/tests/baseline/hull_oracle.h"
#include "geometry/mesh_report.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

// Exactly: the three corners of the triangle lie in the hull, so all of it does.
bool holds(const TriangleMesh& part, const TriangleMesh& mesh, const Eigen::Vector3i& triangle) {
  std::vector<Eigen::Vector3d> corners;
  for (const int v : triangle) corners.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  return exact_outside(part, corners) == 0;
}

void expect_parts(const TriangleMesh& mesh, const ConvexDecomposition& result) {
  for (const TriangleMesh& part : result.parts) {
    EXPECT_TRUE(is_sphere(part));
    EXPECT_GT(mesh_report(part, {.self_intersections = false}).volume, 0.0);
  }
  for (const Eigen::Vector3i& t : mesh.triangles) {
    EXPECT_TRUE(std::any_of(result.parts.begin(), result.parts.end(),
                            [&](const TriangleMesh& part) { return holds(part, mesh, t); }));
  }
}

TEST(ConvexDecomposition, EveryTriangleLiesInAPart) {
  for (const char* name :
       effort(std::vector{"l-bracket", "open-box", "cube", "pipe", "three-fins", "nested-shells"},
              2)) {
    SCOPED_TRACE(name);
    for (const NamedMesh& named : mesh_zoo()) {
      if (named.name != name || named.mesh.triangles.size() > 200) continue;
      ConvexDecompositionOptions options;
      options.measure.reset();
      expect_parts(named.mesh, decompose(named.mesh, options));
    }
  }
}

TEST(ConvexDecomposition, TheBendOfABracketStaysFree) {
  const TriangleMesh bracket = l_bracket();
  const ConvexDecomposition fine = decompose(bracket, {.max_concavity = 0.01});
  expect_parts(bracket, fine);
  EXPECT_GE(fine.parts.size(), 2U);
  EXPECT_LE(fine.deviation.loss.upper, 0.01);
  // Joined to one part it is the hull, which fills the bend.
  const ConvexDecomposition one = decompose(bracket, {.max_concavity = 10.0});
  EXPECT_EQ(one.parts.size(), 1U);
  EXPECT_GT(one.deviation.excess.lower, 0.2);
  EXPECT_LT(fine.deviation.excess.upper, one.deviation.excess.lower);
  EXPECT_NEAR(one.volume, mesh_report(one.parts.front(), {}).volume, 1e-12);
}

TEST(ConvexDecomposition, DegenerateTrianglesAndDuplicatesAreHeldToo) {
  for (const TriangleMesh& mesh :
       {with_degenerates(cube_mesh()), with_duplicates(l_bracket()), soup(12, 5)}) {
    expect_parts(mesh, decompose(mesh, {.measure = std::nullopt}));
  }
}

TEST(ConvexDecomposition, AFlatMeshBecomesAPlate) {
  TriangleMesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const ConvexDecomposition result = decompose(sheet);
  expect_parts(sheet, result);
  EXPECT_LE(result.deviation.excess.upper, 3e-3);
}

TEST(ConvexDecomposition, EqualInputGivesEqualParts) {
  const TriangleMesh mesh = torus(1.0, 0.3, 16, 8);
  const ConvexDecomposition a = decompose(mesh, {.measure = std::nullopt});
  const ConvexDecomposition b = decompose(mesh, {.measure = std::nullopt});
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].vertices, b.parts[i].vertices);
    EXPECT_EQ(a.parts[i].triangles, b.parts[i].triangles);
  }
}

TEST(ConvexDecomposition, BadInputIsRefused) {
  EXPECT_THROW(decompose(TriangleMesh{}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.max_concavity = -1.0}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.max_concavity = std::nan("")}), Error);
  EXPECT_THROW(decompose(cube_mesh(), {.min_parts = 0}), Error);
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(decompose(line), Error);
}

}  // namespace
}  // namespace spherule::test
