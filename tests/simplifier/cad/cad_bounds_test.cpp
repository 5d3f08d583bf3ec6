// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_distance.h"
#include "geometry/mesh_report.h"
#include "io/cad/cad_file.h"
#include "io/cad/cad_shape.h"
#include "tests/simplifier/cad/cad_parts.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace spherule::test::cad_bounds_test {
namespace {

using Eigen::Vector3d;

// The largest distance of the points from the mesh.
double farthest(const TriangleMesh& mesh, const std::vector<Vector3d>& points) {
  const MeshDistance distance(mesh);
  double largest = 0.0;
  for (const Vector3d& p : points) largest = std::max(largest, distance(p).upper);
  return largest;
}

class CadBounds : public ::testing::Test {
 protected:
  CadPart read(const TopoDS_Shape& shape, double chord_error, const char* name = "part.step") {
    const std::filesystem::path path = folder_.path() / name;
    if (path.extension() == ".igs") {
      write_iges(shape, path);
    } else {
      write_step(shape, path);
    }
    return read_cad(path, {.chord_error = chord_error});
  }

  TempDir folder_;
};

class CadBoundsOf : public CadBounds, public ::testing::WithParamInterface<std::string> {};

TEST_P(CadBoundsOf, DerivativesAreBounded) {
  double tightest = 0.0;
  EXPECT_EQ(broken_bounds(shape_named(GetParam()), effort(60, 10), tightest), "");
  // Bounds that say too much are no use either.
  EXPECT_TRUE(GetParam() == "box" || tightest > 0.2) << tightest;
}

// The points are of the shape as it was made, and OpenCASCADE says where they are.
TEST_P(CadBoundsOf, EveryPointOfThePartIsWithinTheBound) {
  const TopoDS_Shape shape = shape_named(GetParam());
  const std::vector<Vector3d> points = points_of(shape, effort(2000, 300));
  for (const double asked : {1.0, 0.2}) {
    SCOPED_TRACE(asked);
    const CadPart part = read(shape, asked);
    EXPECT_TRUE(part.proved);
    for (const UnprovedFace& face : part.unproved) {
      ADD_FAILURE() << face.name << ": " << face.reason;
    }
    EXPECT_LE(part.chord_error, asked);
    EXPECT_GE(part.mesh.vertex_error, part.chord_error);
    const double found = farthest(part.mesh, points);
    EXPECT_LE(found, part.chord_error);
    EXPECT_LE(part.reached, part.chord_error);
    // Neither the samples nor the bound say nothing.
    EXPECT_GE(found, 0.5 * part.reached - 1e-9);
    EXPECT_LE(part.chord_error, std::max(1.05 * part.reached, 0.5 * asked) + 1.1 * part.tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, CadBoundsOf, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const NamedShape& shape : provable_shapes())
                             names.push_back(shape.name);
                           return names;
                         }()),
                         [](const auto& shape) { return shape.param; });

// The piece whose weights are all equal comes from OpenCASCADE without them.
TEST(CadJump, IsBoundedBetweenPiecesOfDifferentWeight) {
  for (const double weight : {1.0, 1000.0, 0.001}) {
    const BentSheet sheet = bent_sheet(weight);
    const internal::Interval across{0.0, 11.0};
    const internal::Interval along{0.0, 1.0};
    const double u_jump = internal::surface_of(sheet.extruded).bound(across, along).jump_u;
    EXPECT_GE(u_jump, 1.0 - 1e-9) << weight;
    EXPECT_LE(u_jump, 1.1 * sheet.jump) << weight;
    EXPECT_GE(u_jump, sheet.jump * (1.0 - 1e-9)) << weight;
    EXPECT_GE(internal::surface_of(sheet.bent_along_u).bound(across, along).jump_u,
              sheet.jump * (1.0 - 1e-9));
    EXPECT_GE(internal::surface_of(sheet.bent_along_v).bound(along, across).jump_v,
              sheet.jump * (1.0 - 1e-9));
  }
}

TEST_F(CadBounds, SolidsComeOutClosed) {
  for (const char* name : {"box", "cylinder", "cone", "sphere", "torus", "plate", "spline_torus"}) {
    const CadPart part = read(shape_named(name), 0.2);
    const MeshReport report = mesh_report(part.mesh);
    EXPECT_TRUE(report.closed) << name;
    EXPECT_GT(report.volume, 0.0) << name;
  }
}

TEST_F(CadBounds, IgesKeepsThePromise) {
  for (const char* name : {"plate", "torus", "spline_sphere", "revolved_spline"}) {
    const TopoDS_Shape shape = shape_named(name);
    const CadPart part = read(shape, 0.3, "part.igs");
    EXPECT_TRUE(part.proved) << name << (part.proved ? "" : part.unproved[0].reason);
    const double found = farthest(part.mesh, points_of(shape, effort(1500, 300)));
    EXPECT_LE(found, part.chord_error) << name;
    EXPECT_GE(found, 0.3 * part.reached) << name;
  }
}

TEST_F(CadBounds, WhatIsNotProvedSaysSo) {
  const TopoDS_Shape shape = offset_face();
  const CadPart part = read(shape, 2.0);
  EXPECT_FALSE(part.proved);
  ASSERT_EQ(part.unproved.size(), 1u);
  EXPECT_NE(part.unproved[0].name.find("face 1 (OffsetSurface)"), std::string::npos)
      << part.unproved[0].name;
  EXPECT_GE(part.chord_error, 2.0 * part.reached);
  EXPECT_LE(farthest(part.mesh, points_of(shape, effort(300, 100))), part.chord_error);
}

}  // namespace
}  // namespace spherule::test::cad_bounds_test
