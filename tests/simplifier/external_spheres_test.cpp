// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "geometry/mesh_distance.h"
#include "simplifier/internal/stages.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <string>

namespace spherule::test::external_spheres_test {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kPlacements{ExternalPlacement::kReachable, ExternalPlacement::kRandom};

ExternalOptions options_for(ExternalPlacement placement, double diameter) {
  ExternalOptions options;
  options.placement = placement;
  options.min_external_diameter = diameter;
  options.limit = static_cast<std::size_t>(effort(3000, 800));
  return options;
}

double diagonal(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : mesh.vertices) box.extend(v);
  return box.diagonal().norm();
}

// Two plates of 6 x 6 x 1 with a gap between them.
TriangleMesh two_plates(double gap) {
  return joined(box_mesh({0, 0, 0}, {6, 6, 1}), box_mesh({0, 0, 1 + gap}, {6, 6, 2 + gap}));
}

TEST(ExternalSpheres, EverySphereIsFreeOfThePaddedMeshAndLargeEnough) {
  std::size_t examined = 0;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const double size = diagonal(named.mesh);
    for (const ExternalPlacement placement : kPlacements) {
      for (const double padding : {0.0, 0.03 * size}) {
        ExternalOptions options = options_for(placement, (kSanitized ? 0.5 : 0.25) * size);
        options.padding = padding;
        TriangleMesh mesh = named.mesh;
        mesh.vertex_error = padding / 16.0;
        const ExternalSpheres external = place_external_spheres(mesh, options);
        ASSERT_GE(external.padding, padding + mesh.vertex_error);
        const std::size_t stride = kSanitized ? 64 : 16;
        for (std::size_t i = 0; i < external.spheres.size(); i += stride) {
          ++examined;
          const Sphere& sphere = external.spheres[i];
          ASSERT_GE(2.0 * sphere.radius, options.min_external_diameter);
          ASSERT_LE(static_cast<Real>(sphere.radius) + external.padding,
                    judged_mesh_distance(sphere.center, mesh) + 1e-17L * size);
        }
      }
    }
  }
  EXPECT_GT(examined, effort(2000U, 100U));
}

TEST(ExternalSpheres, TheMeshIsInTheSimplifiedSolid) {
  Random random(51);
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const double size = diagonal(named.mesh);
    for (const ExternalPlacement placement : kPlacements) {
      ExternalOptions options = options_for(placement, (kSanitized ? 0.5 : 0.3) * size);
      options.padding = 0.01 * size;
      const ExternalSpheres external = place_external_spheres(named.mesh, options);
      for (const Vector3d& p :
           points_on_surface(named.mesh, static_cast<std::size_t>(effort(200, 20)), random)) {
        // The surface and a point of it grown by the padding.
        ASSERT_TRUE(is_in_solid(p, external));
        ASSERT_TRUE(is_in_solid(p + 0.999999 * options.padding * random.direction(), external));
      }
    }
  }
}

TEST(ExternalSpheres, AGapNarrowerThanTheDiameterIsFilled) {
  const double gap = 2.0;
  const Vector3d middle(3, 3, 1 + gap / 2);
  for (const ExternalPlacement placement : kPlacements) {
    for (const double diameter : effort(std::vector{2.0001, 2.2, 3.0}, 1)) {
      ExternalOptions options = options_for(placement, diameter);
      options.limit = static_cast<std::size_t>(effort(10000, 2000));
      EXPECT_TRUE(is_in_solid(middle, place_external_spheres(two_plates(gap), options)));
    }
  }
  // The padding narrows the gap.
  ExternalOptions options = options_for(ExternalPlacement::kReachable, 1.5);
  options.padding = 0.2501;
  EXPECT_TRUE(is_in_solid(middle, place_external_spheres(two_plates(gap), options)));
}

TEST(ExternalSpheres, AGapWiderThanTheDiameterAndTheSlackIsKeptOpen) {
  for (const double step : effort(std::vector{0.5, 0.25, 0.17}, 1)) {
    ExternalOptions options = options_for(ExternalPlacement::kReachable, 2.0);
    options.grid_step = step;
    const double slack = place_external_spheres(two_plates(1.0), options).closing_slack;
    ASSERT_GT(slack, 0.0);
    ASSERT_LT(slack, 3.0 * step);
    const double gap = 2.0 + slack * 1.0001;
    for (const double shift : effort(std::vector{0.1, 0.0, 0.21}, 1)) {
      // The shift moves the grid against the gap.
      TriangleMesh mesh = two_plates(gap);
      mesh = joined(mesh, box_mesh({0, 0, -2.0 - shift}, {0.1, 0.1, -1.0}));
      const ExternalSpheres external = place_external_spheres(mesh, options);
      EXPECT_EQ(external.closing_slack, slack);
      EXPECT_FALSE(is_in_solid({3, 3, 1 + gap / 2}, external)) << step << " " << shift;
    }
  }
}

TEST(ExternalSpheres, AClosedCavityIsFilledHoweverLarge) {
  const TriangleMesh hollow =
      joined(box_mesh({0, 0, 0}, {10, 10, 10}), inverted(box_mesh({1, 1, 1}, {9, 9, 9})));
  Random random(52);
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d::Constant(10));
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = options_for(placement, 1.0);
    options.grid_step = 0.25;
    const ExternalSpheres external = place_external_spheres(hollow, options);
    for (int i = 0; i < 1000; ++i) ASSERT_TRUE(is_in_solid(random.in_box(box), external));
  }
}

TEST(ExternalSpheres, ABoreIsFilledForAWideToolAndOpenForANarrowOne) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = pipe(20, 17, 300, 81);
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = options_for(placement, 100);
    const ExternalSpheres wide = place_external_spheres(mesh, options);
    options.min_external_diameter = 20;
    options.limit = 30000;
    const ExternalSpheres narrow = place_external_spheres(mesh, options);
    int open = 0;
    for (int z = 20; z <= 280; z += 10) {
      ASSERT_TRUE(is_in_solid({0, 0, static_cast<double>(z)}, wide));
      if (!is_in_solid({0, 0, static_cast<double>(z)}, narrow)) ++open;
    }
    EXPECT_EQ(open, 27);
  }
}

TEST(ExternalSpheres, WithoutPlacementTheSolidIsTheBox) {
  ExternalOptions options;
  options.placement = ExternalPlacement::kNone;
  options.padding = 0.5;
  const ExternalSpheres external = place_external_spheres(cube_mesh(), options);
  EXPECT_TRUE(external.spheres.empty());
  EXPECT_LE(external.box.min().maxCoeff(), -0.5);
  EXPECT_GE(external.box.max().minCoeff(), 1.5);
  EXPECT_NEAR(external.box.sizes().norm(), 2.0 * std::sqrt(3.0), 1e-12);
}

TEST(ExternalSpheres, AreEqualInEveryRunOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const ExternalPlacement placement : kPlacements) {
    const ExternalOptions options = options_for(placement, 0.3);
    const ExternalSpheres first = place_external_spheres(l_bracket(), options);
    EXPECT_EQ(place_external_spheres(l_bracket(), options).spheres, first.spheres);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(place_external_spheres(l_bracket(), options).spheres, first.spheres);
  }
  ExternalOptions other = options_for(ExternalPlacement::kRandom, 0.3);
  const ExternalSpheres first = place_external_spheres(l_bracket(), other);
  other.seed = 2;
  EXPECT_NE(place_external_spheres(l_bracket(), other).spheres, first.spheres);
  EXPECT_EQ(first.nodes_examined, other.limit);
}

// Whether parallel loops may use one thread only, as a callback from within sees it.
bool one_thread_allowed() {
  using tbb::global_control;
  return global_control::active_value(global_control::max_allowed_parallelism) == 1;
}

TEST(ExternalSpheres, TellOfTheirProgressAndKeepToTheThreadsTheyAreGiven) {
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = options_for(placement, 0.5);
    options.threads = 1;
    double last = 0.0;
    int calls = 0;
    options.progress = [&](double share, const char* what) {
      ++calls;
      EXPECT_TRUE(one_thread_allowed());
      EXPECT_GT(share, last);
      EXPECT_LE(share, 1.0);
      EXPECT_STRNE(what, "");
      last = share;
    };
    place_external_spheres(cube_mesh(), options);
    EXPECT_GE(calls, 3);
    EXPECT_FALSE(one_thread_allowed());
  }
}

// Before the two finest levels are examined, of which each has about four times the cells of the
// one before.
TEST(ExternalSpheres, TooManyCellsAreForeseenAndTheReasonSaysWhatToChoose) {
  ExternalOptions options = options_for(ExternalPlacement::kReachable, 0.01);
  options.max_cells = std::size_t{1} << 20;
  double last = 0.0;
  options.progress = [&](double share, const char*) { last = share; };
  try {
    place_external_spheres(cube_mesh(), options);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "grid step");
    EXPECT_NE(std::string(error.what()).find("with a min external diameter "), std::string::npos)
        << error.what();
  }
  EXPECT_GT(last, 0.0);
  EXPECT_LT(last, 0.9 / 16.0 + 1e-9);
}

// Coarser, and still what is promised of every grid; where that is not enough, or the step was
// requested, it is refused.
TEST(ExternalSpheres, WhereCellsAreTooManyTheGridIsCoarser) {
  ExternalOptions options = options_for(ExternalPlacement::kReachable, 0.25);
  options.max_error = 0.01;
  const ExternalSpheres fine = place_external_spheres(l_bracket(), options);
  options.max_cells = fine.nodes_examined / 2;
  const ExternalSpheres coarse = place_external_spheres(l_bracket(), options);
  EXPECT_LE(coarse.nodes_examined, options.max_cells);
  EXPECT_GT(coarse.grid_step, 1.2 * fine.grid_step);
  EXPECT_LT(coarse.grid_step, 2.51 * fine.grid_step);
  EXPECT_LE(coarse.closing_slack, 0.25 * options.tightness);
  ASSERT_FALSE(coarse.spheres.empty());
  for (const Sphere& sphere : coarse.spheres) {
    EXPECT_GE(judged_mesh_distance(sphere.center, l_bracket()), sphere.radius);
  }
  options.grid_step = fine.grid_step;
  EXPECT_THROW(place_external_spheres(l_bracket(), options), Error);
  options.grid_step = 0.0;
  options.max_cells = fine.nodes_examined / 50;
  EXPECT_THROW(place_external_spheres(l_bracket(), options), Error);
}

// One that was requested is not changed; of one that was not, no more than is needed.
TEST(ExternalSpheres, WhereCellsAreTooManyADefaultDiameterIsLarger) {
  ExternalOptions options = options_for(ExternalPlacement::kReachable, 0.1);
  options.max_error = 0.1 / 4.0;
  const MeshDistance distance(l_bracket());
  const auto used = [&](const ExternalOptions& by) {
    return internal::place_with_default_diameter(l_bracket(), distance, by);
  };
  EXPECT_EQ(used(options).min_external_diameter, 0.1);
  // A quarter of the cells is for such grids.
  options.max_cells = 29 * used(options).nodes_examined / 10;
  const ExternalSpheres larger = used(options);
  EXPECT_LE(larger.nodes_examined, options.max_cells);
  EXPECT_GT(larger.min_external_diameter, 0.1);
  EXPECT_LE(larger.min_external_diameter, 0.1 * distance.box().diagonal().norm());
  ASSERT_FALSE(larger.spheres.empty());
  for (const Sphere& sphere : larger.spheres) {
    EXPECT_GE(sphere.radius, larger.min_external_diameter / 2.0);
  }
  ExternalOptions least = options;
  least.min_external_diameter = larger.min_external_diameter / 1.4;
  least.max_cells = options.max_cells / 4;
  EXPECT_THROW(place_external_spheres(l_bracket(), least), Error) << "more than was needed";
  // Above a tenth of the diagonal D stays as it is, for which all the cells may be taken.
  options.max_cells = 2000;
  EXPECT_THROW(used(options), Error);
  options.min_external_diameter = 0.5;
  options.max_error = 0.2;
  options.max_cells = ExternalOptions::kMostCells;
  options.max_cells = place_external_spheres(l_bracket(), options).nodes_examined;
  EXPECT_EQ(used(options).min_external_diameter, 0.5);
}

TEST(ExternalSpheres, ThePaddingIsTheSumOfTheTwoGivenWhereThereAreTwo) {
  ExternalOptions options = options_for(ExternalPlacement::kNone, 0.0);
  TriangleMesh mesh = cube_mesh();
  const auto padding = [&] { return place_external_spheres(mesh, options).padding; };
  EXPECT_EQ(padding(), 0.0);
  mesh.vertex_error = 0.1;
  EXPECT_EQ(padding(), 0.1);
  options.padding = 0.2;
  EXPECT_GE(padding(), 0.1L + 0.2L);
  EXPECT_LE(padding(), 0.3 + 1e-15);
  mesh.vertex_error = 0.0;
  EXPECT_EQ(padding(), 0.2);
}

std::string refused(const ExternalOptions& options, const TriangleMesh& mesh = cube_mesh()) {
  try {
    place_external_spheres(mesh, options);
  } catch (const Error& error) {
    return error.subject();
  }
  return "accepted";
}

TEST(ExternalSpheres, SaysWhetherAModelIsTooLargeOrTooFarFromItsOrigin) {
  const auto refusal = [](double from, double size) {
    const TriangleMesh mesh = box_mesh(Vector3d::Constant(from), Vector3d::Constant(from + size));
    try {
      place_external_spheres(mesh, options_for(ExternalPlacement::kReachable, 0.04));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_NE(refusal(1e8, 0.1).find("with coordinates of up to 1e+08"), std::string::npos);
  EXPECT_NE(refusal(0.0, 1e8).find("steps wide: fit it in parts"), std::string::npos);
  EXPECT_EQ(refusal(1e4, 0.1), "none");
}

TEST(ExternalSpheres, BadOptionsAreRefusedByName) {
  for (const ExternalPlacement placement : kPlacements) {
    for (const double bad : {0.0, -1.0, kNan, kInfinity, 1e300}) {
      EXPECT_EQ(refused(options_for(placement, bad)), "min external diameter") << bad;
    }
    for (const double bad : {-1.0, kNan, kInfinity}) {
      ExternalOptions options = options_for(placement, 0.5);
      options.padding = bad;
      EXPECT_EQ(refused(options), "padding") << bad;
    }
  }
  for (const double bad : {-1.0, kNan, 1e-12, kInfinity}) {
    ExternalOptions options = options_for(ExternalPlacement::kReachable, 0.5);
    options.grid_step = bad;
    EXPECT_EQ(refused(options), "grid step") << bad;
  }
  for (const std::size_t bad : {std::size_t{0}, ExternalOptions::kMostCells + 1}) {
    ExternalOptions options = options_for(ExternalPlacement::kReachable, 0.5);
    options.max_cells = bad;
    EXPECT_EQ(refused(options), "max cells") << bad;
  }
  EXPECT_EQ(refused(options_for(ExternalPlacement::kReachable, 1e-9)), "grid step");
  // The search would not end in a mesh of such a size.
  for (const double bad : {5e-324, 0.9e-60}) {
    const ExternalOptions options = options_for(ExternalPlacement::kReachable, bad);
    EXPECT_EQ(refused(options, box_mesh(Vector3d::Zero(), Vector3d::Constant(10.0 * bad))),
              "min external diameter")
        << bad;
  }
  EXPECT_EQ(refused(options_for(ExternalPlacement::kReachable, 0.5), {}), "mesh");
  TriangleMesh broken = cube_mesh();
  broken.vertices[3].y() = kNan;
  EXPECT_EQ(refused(options_for(ExternalPlacement::kReachable, 0.5), broken), "mesh");
}

}  // namespace
}  // namespace spherule::test::external_spheres_test
