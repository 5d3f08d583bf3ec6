// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover_breakdown.h"

#include "base/error.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

CoverBreakdown breakdown_of(const TriangleMesh& mesh, const Fit& fitted) {
  CoverBreakdown result =
      cover_breakdown(mesh, fitted.external, fitted.cover.spheres, fitted.max_error);
  EXPECT_EQ(result.edges + result.thin + result.faces + result.inside, fitted.cover.spheres.size());
  return result;
}

// Some sphere along each of the twelve edges, in its middle half: at a point that two spheres cover
// neither is there for it.
TEST(CoverBreakdown, ACubeCostsItsEdges) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit(mesh, {}, {.max_error = 0.06});
  const CoverBreakdown found = breakdown_of(mesh, fitted);
  EXPECT_GE(2 * found.edges, fitted.cover.spheres.size());
  EXPECT_EQ(found.thin, 0U);
  std::size_t edges = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Vector3d middle = Vector3d::Constant(0.5);
      middle[(axis + 1) % 3] = corner % 2;
      middle[(axis + 2) % 3] = corner / 2;
      for (std::size_t i = 0; i < found.roles.size(); ++i) {
        const Sphere& sphere = fitted.cover.spheres[i];
        if (found.roles[i] != SphereRole::kEdge) continue;
        middle[axis] = std::clamp(sphere.center[axis], 0.25, 0.75);
        if ((sphere.center - middle).norm() > sphere.radius) continue;
        ++edges;
        break;
      }
    }
  }
  EXPECT_EQ(edges, 12U);
}

// The same whichever way the triangles face.
TEST(CoverBreakdown, OrientationDoesNotMatter) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit(mesh, {}, {.max_error = 0.06});
  EXPECT_EQ(breakdown_of(inverted(mesh), fitted).roles, breakdown_of(mesh, fitted).roles);
}

TEST(CoverBreakdown, APlateIsThin) {
  const TriangleMesh mesh = thin_sheet(0.01);
  const Fit fitted = fit(mesh, {}, {.max_error = 0.03});
  const CoverBreakdown found = breakdown_of(mesh, fitted);
  const std::size_t count = fitted.cover.spheres.size();
  EXPECT_GT(found.thin, kSanitized ? count / 3 : count / 2);
  EXPECT_GT(found.edges, 0U);
  EXPECT_EQ(found.faces, 0U);
}

TEST(CoverBreakdown, ASphereHasFacesOnly) {
  const TriangleMesh mesh = icosphere(3);
  const FitShares shares{.max_error = 0.02};
  const ExternalSpheres external = externals_of(mesh, shares);
  std::vector<Sphere> spheres;  // on the surface, as if the one inside were missing
  for (const Vector3d& v : mesh.vertices) spheres.push_back({0.8 * v, 0.22});
  const CoverBreakdown found =
      cover_breakdown(mesh, external, spheres, shares.max_error * diagonal_of(mesh));
  EXPECT_EQ(found.faces, spheres.size() - found.inside);
  EXPECT_GT(found.faces, spheres.size() / 3);
}

// Counted by the gaps to all external spheres and to the box.
TEST(SpheresInThinParts, AreThoseWhoseCentresAreNearTheOutside) {
  std::size_t in_plate = 0;
  for (const TriangleMesh& mesh : {thin_sheet(0.01), cube_mesh()}) {
    const Fit fitted = fit(mesh, {}, {.max_error = 0.03});
    std::size_t thin = 0;
    for (const Sphere& sphere : fitted.cover.spheres) {
      const Vector3d& c = sphere.center;
      double gap = std::min((c - fitted.external.box.min()).minCoeff(),
                            (fitted.external.box.max() - c).minCoeff());
      for (const Sphere& outside : fitted.external.spheres) {
        gap = std::min(gap, (c - outside.center).norm() - outside.radius);
      }
      if (gap < fitted.max_error) ++thin;
    }
    EXPECT_EQ(spheres_in_thin_parts(fitted.external, fitted.cover.spheres, fitted.max_error), thin);
    if (in_plate == 0) {
      in_plate = thin;
      EXPECT_EQ(thin, fitted.cover.spheres.size());
    } else {
      EXPECT_LT(thin, fitted.cover.spheres.size() / 2);
    }
  }
  EXPECT_THROW(spheres_in_thin_parts({}, {}, 0.0), Error);
}

// A concave edge is no edge of S that costs spheres.
TEST(CoverBreakdown, ConcaveEdgesAreNone) {
  const TriangleMesh mesh = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 0, 0}, {2, 2, 1}));
  const FitShares shares{.max_error = 0.03};
  const ExternalSpheres external = externals_of(mesh, shares);
  const std::vector<Sphere> spheres = {{{1.0, 1.0, 0.5}, 0.1}, {{0.0, 0.0, 0.5}, 0.1}};
  const CoverBreakdown found =
      cover_breakdown(mesh, external, spheres, shares.max_error * diagonal_of(mesh));
  EXPECT_NE(found.roles[0], SphereRole::kEdge);
  EXPECT_EQ(found.roles[1], SphereRole::kEdge);
}

TEST(CoverBreakdown, RefusesErrorsOutOfRange) {
  const TriangleMesh mesh = cube_mesh();
  const ExternalSpheres external = externals_of(mesh, {});
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300}) {
    EXPECT_THROW(cover_breakdown(mesh, external, {}, bad), Error) << bad;
  }
}

}  // namespace
}  // namespace spherule::test
