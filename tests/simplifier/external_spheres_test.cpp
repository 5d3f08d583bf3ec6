// SPDX-License-Identifier: BSD-3-Clause
// External spheres are free of the padded mesh, are where a tool of the least diameter can get, and
// nowhere else.
#include "geometry/mesh_distance.h"
#include "simplifier/internal/stages.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::array kPlacements{ExternalPlacement::kReachable, ExternalPlacement::kRandom};

ExternalOptions of_diameter(double diameter,
                            ExternalPlacement placement = ExternalPlacement::kReachable) {
  return {.placement = placement, .min_external_diameter = diameter, .limit = samples(3000, 800)};
}

// Two plates of 6 x 6 x 1 with a gap between them.
TriangleMesh two_plates(double gap) {
  return joined(box_mesh({0, 0, 0}, {6, 6, 1}), box_mesh({0, 0, 1 + gap}, {6, 6, 2 + gap}));
}

TEST(ExternalSpheres, AreFreeOfThePaddedMeshWhichIsInTheSolid) {
  std::size_t examined = 0;
  Random random(51);
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const double size = diagonal_of(named.mesh);
    for (const ExternalPlacement placement : kPlacements) {
      for (const double padding : {0.0, 0.03 * size}) {
        ExternalOptions options = of_diameter((kSanitized ? 0.5 : 0.25) * size, placement);
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
        // The surface and a point of it grown by the padding.
        for (const Vector3d& p : points_on_surface(mesh, samples(200, 20), random)) {
          ASSERT_TRUE(is_in_solid(p, external));
          ASSERT_TRUE(is_in_solid(p + 0.999999 * padding * random.direction(), external));
        }
      }
    }
  }
  EXPECT_GT(examined, effort(2000U, 100U));
}

TEST(ExternalSpheres, AGapNarrowerThanTheDiameterIsFilled) {
  const double gap = 2.0;
  const auto is_filled = [&](const ExternalOptions& options) {
    return is_in_solid({3, 3, 1 + gap / 2}, place_external_spheres(two_plates(gap), options));
  };
  for (const ExternalPlacement placement : kPlacements) {
    for (const double diameter : effort(std::vector{2.0001, 2.2, 3.0}, 1)) {
      ExternalOptions options = of_diameter(diameter, placement);
      options.limit = samples(10000, 2000);
      EXPECT_TRUE(is_filled(options));
    }
  }
  // The padding narrows the gap.
  ExternalOptions options = of_diameter(1.5);
  options.padding = 0.2501;
  EXPECT_TRUE(is_filled(options));
}

TEST(ExternalSpheres, AGapWiderThanTheDiameterAndTheSlackIsKeptOpen) {
  for (const double step : effort(std::vector{0.5, 0.25, 0.17}, 1)) {
    ExternalOptions options = of_diameter(2.0);
    options.grid_step = step;
    const double slack = place_external_spheres(two_plates(1.0), options).closing_slack;
    ASSERT_GT(slack, 0.0);
    ASSERT_LT(slack, 3.0 * step);
    const double gap = 2.0 + slack * 1.0001;
    // The shift moves the grid against the gap.
    for (const double shift : effort(std::vector{0.1, 0.0, 0.21}, 1)) {
      const TriangleMesh mesh =
          joined(two_plates(gap), box_mesh({0, 0, -2.0 - shift}, {0.1, 0.1, -1.0}));
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
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = of_diameter(1.0, placement);
    options.grid_step = 0.25;
    const ExternalSpheres external = place_external_spheres(hollow, options);
    for (int i = 0; i < 1000; ++i) {
      ASSERT_TRUE(is_in_solid(random.in_box({Vector3d::Zero(), Vector3d::Constant(10)}), external));
    }
  }
}

TEST(ExternalSpheres, ABoreIsFilledForAWideToolAndOpenForANarrowOne) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = pipe(20, 17, 300, 81);
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = of_diameter(100, placement);
    const ExternalSpheres wide = place_external_spheres(mesh, options);
    options.min_external_diameter = 20;
    options.limit = 30000;
    const ExternalSpheres narrow = place_external_spheres(mesh, options);
    for (double z = 20; z <= 280; z += 10) {
      EXPECT_TRUE(is_in_solid({0, 0, z}, wide)) << z;
      EXPECT_FALSE(is_in_solid({0, 0, z}, narrow)) << z;
    }
  }
}

TEST(ExternalSpheres, WithoutPlacementTheSolidIsTheBox) {
  const ExternalSpheres external =
      place_external_spheres(cube_mesh(), {.placement = ExternalPlacement::kNone, .padding = 0.5});
  EXPECT_TRUE(external.spheres.empty());
  EXPECT_LE(external.box.min().maxCoeff(), -0.5);
  EXPECT_GE(external.box.max().minCoeff(), 1.5);
  EXPECT_NEAR(external.box.sizes().norm(), 2.0 * std::sqrt(3.0), 1e-12);
}

TEST(ExternalSpheres, ThePaddingIsTheSumOfTheTwoGivenWhereThereAreTwo) {
  const auto padding = [](double vertex_error, double requested) {
    TriangleMesh mesh = cube_mesh();
    mesh.vertex_error = vertex_error;
    return place_external_spheres(mesh,
                                  {.placement = ExternalPlacement::kNone, .padding = requested})
        .padding;
  };
  EXPECT_EQ(padding(0.0, 0.0), 0.0);
  EXPECT_EQ(padding(0.1, 0.0), 0.1);
  EXPECT_EQ(padding(0.0, 0.2), 0.2);
  EXPECT_GE(padding(0.1, 0.2), 0.1L + 0.2L);
  EXPECT_LE(padding(0.1, 0.2), 0.3 + 1e-15);
}

TEST(ExternalSpheres, AreEqualInEveryRunOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const auto spheres = [](const ExternalOptions& options) {
    return place_external_spheres(l_bracket(), options).spheres;
  };
  for (const ExternalPlacement placement : kPlacements) {
    const ExternalOptions options = of_diameter(0.3, placement);
    const std::vector<Sphere> first = spheres(options);
    EXPECT_EQ(spheres(options), first);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(spheres(options), first);
  }
  ExternalOptions other = of_diameter(0.3, ExternalPlacement::kRandom);
  const ExternalSpheres first = place_external_spheres(l_bracket(), other);
  EXPECT_EQ(first.nodes_examined, other.limit);
  other.seed = 2;
  EXPECT_NE(spheres(other), first.spheres);
}

// Whether parallel loops may use one thread only, as a callback from within sees it.
bool one_thread_allowed() {
  using tbb::global_control;
  return global_control::active_value(global_control::max_allowed_parallelism) == 1;
}

TEST(ExternalSpheres, TellOfTheirProgressAndKeepToTheThreadsTheyAreGiven) {
  for (const ExternalPlacement placement : kPlacements) {
    ExternalOptions options = of_diameter(0.5, placement);
    options.threads = 1;
    std::vector<double> shares{0.0};
    options.progress = [&](double share, const char* what) {
      EXPECT_TRUE(one_thread_allowed());
      EXPECT_GT(share, shares.back());
      EXPECT_STRNE(what, "");
      shares.push_back(share);
    };
    place_external_spheres(cube_mesh(), options);
    EXPECT_GT(shares.size(), 3U);
    EXPECT_LE(shares.back(), 1.0);
    EXPECT_FALSE(one_thread_allowed());
  }
}

// --- too many cells ---

// Before the two finest levels are examined, of which each has about four times the cells of the
// one before.
TEST(ExternalSpheres, TooManyCellsAreForeseenAndTheReasonSaysWhatToChoose) {
  ExternalOptions options = of_diameter(0.01);
  options.max_cells = std::size_t{1} << 20;
  double last = 0.0;
  options.progress = [&](double share, const char*) { last = share; };
  const std::string said = refusal([&] { place_external_spheres(cube_mesh(), options); });
  EXPECT_TRUE(said.starts_with("grid step: ")) << said;
  EXPECT_NE(said.find("with a min external diameter "), std::string::npos) << said;
  EXPECT_GT(last, 0.0);
  EXPECT_LT(last, 0.9 / 16.0 + 1e-9);
}

// Coarser, and still what is promised of every grid; where that is not enough, or the step was
// requested, it is refused.
TEST(ExternalSpheres, WhereCellsAreTooManyTheGridIsCoarser) {
  ExternalOptions options = of_diameter(0.25);
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
  ExternalOptions options = of_diameter(0.1);
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

// --- refusals ---

TEST(ExternalSpheres, SaysWhetherAModelIsTooLargeOrTooFarFromItsOrigin) {
  const auto said = [](double from, double size) {
    const TriangleMesh mesh = box_mesh(Vector3d::Constant(from), Vector3d::Constant(from + size));
    return refusal([&] { place_external_spheres(mesh, of_diameter(0.04)); });
  };
  EXPECT_NE(said(1e8, 0.1).find("with coordinates of up to 1e+08"), std::string::npos);
  EXPECT_NE(said(0.0, 1e8).find("steps wide: fit it in parts"), std::string::npos);
  EXPECT_EQ(said(1e4, 0.1), "accepted");
}

TEST(ExternalSpheres, BadOptionsAreRefusedByName) {
  const auto refused_with = [](auto ExternalOptions::*field, auto value,
                               ExternalPlacement placement = ExternalPlacement::kReachable) {
    ExternalOptions options = of_diameter(0.5, placement);
    options.*field = value;
    return refused([&] { place_external_spheres(cube_mesh(), options); });
  };
  const std::string diameter = "min external diameter";
  for (const ExternalPlacement placement : kPlacements) {
    for (const double bad : {-1.0, kNan, kInfinity}) {
      EXPECT_EQ(refused_with(&ExternalOptions::min_external_diameter, bad, placement), diameter);
      EXPECT_EQ(refused_with(&ExternalOptions::padding, bad, placement), "padding") << bad;
    }
    for (const double bad : {0.0, 1e300}) {
      EXPECT_EQ(refused_with(&ExternalOptions::min_external_diameter, bad, placement), diameter);
    }
  }
  for (const double bad : {-1.0, kNan, 1e-12, kInfinity}) {
    EXPECT_EQ(refused_with(&ExternalOptions::grid_step, bad), "grid step") << bad;
  }
  for (const double bad : {0.0, -1.0, 11.0, kNan}) {
    EXPECT_NE(refused_with(&ExternalOptions::tightness, bad), "accepted") << bad;
  }
  for (const std::size_t bad : {std::size_t{0}, ExternalOptions::kMostCells + 1}) {
    EXPECT_EQ(refused_with(&ExternalOptions::max_cells, bad), "max cells") << bad;
  }
  EXPECT_EQ(refused_with(&ExternalOptions::min_external_diameter, 1e-9), "grid step");
  // The search would not end in a mesh of such a size.
  for (const double bad : {5e-324, 0.9e-60}) {
    const TriangleMesh tiny = box_mesh(Vector3d::Zero(), Vector3d::Constant(10.0 * bad));
    EXPECT_EQ(refused([&] { place_external_spheres(tiny, of_diameter(bad)); }), diameter) << bad;
  }
  TriangleMesh broken = cube_mesh();
  broken.vertices[3].y() = kNan;
  for (const TriangleMesh& mesh : {TriangleMesh{}, broken}) {
    EXPECT_EQ(refused([&] { place_external_spheres(mesh, of_diameter(0.5)); }), "mesh");
  }
}

// --- reach ---

// Whether a sphere of radius rho intersects nothing on the straight way, at points so close
// together that the clearance between two of them is known.
bool passes(const TriangleMesh& mesh, const Vector3d& from, const Vector3d& to, double rho) {
  const double length = (to - from).norm();
  double at = 0.0;
  while (true) {
    const Real room = judged_mesh_distance(from + at * (to - from), mesh) - rho;
    if (room < -1e-12L) return false;
    if (at >= 1.0) return true;
    // Nothing is met for `room`; a sphere that just fits steps on by a hair.
    const double way = std::max(static_cast<double>(room), 0.01 * rho);
    at = std::min(1.0, at + way / length);
  }
}

// Whether the sphere gets straight out of the box along an axis.
bool leaves(const TriangleMesh& mesh, const AlignedBox3d& box, const Vector3d& from, double rho) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool up : {false, true}) {
      Vector3d to = from;
      to[axis] = up ? std::max(from[axis], box.max()[axis] + rho)
                    : std::min(from[axis], box.min()[axis] - rho);
      if (to == from || passes(mesh, from, to, rho)) return true;
    }
  }
  return false;
}

// How many spheres a sphere of radius rho gets to from outside, straight from sphere to sphere.
std::size_t reached(const TriangleMesh& mesh, const ExternalSpheres& external) {
  const double rho = external.min_external_diameter / 2.0;
  const std::vector<Sphere>& spheres = external.spheres;
  std::vector<std::size_t> front, unseen;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    (leaves(mesh, external.box, spheres[i].center, rho) ? front : unseen).push_back(i);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const Sphere here = spheres[front[k]];
    std::erase_if(unseen, [&](std::size_t i) {
      const Sphere& there = spheres[i];
      if ((there.center - here.center).norm() >= there.radius + here.radius) return false;
      if (!passes(mesh, here.center, there.center, rho)) return false;
      front.push_back(i);
      return true;
    });
  }
  return front.size();
}

// A pipe with a lid on one end, bent at a right angle: its far part is reached through the bend
// only, and nothing in it leaves straight.
TriangleMesh bent_duct() {
  const std::vector<AlignedBox3d> walls = {
      {Vector3d(0, 0, 0), Vector3d(6, 3, 0.5)},    // floor
      {Vector3d(0, 0, 2.5), Vector3d(6, 3, 3)},    // ceiling
      {Vector3d(0, 0, 0), Vector3d(0.5, 6, 3)},    // outer wall of the bend
      {Vector3d(0, 0, 0), Vector3d(6, 0.5, 3)},    // outer wall
      {Vector3d(2.5, 2.5, 0), Vector3d(6, 3, 3)},  // inner wall
      {Vector3d(5.5, 0, 0), Vector3d(6, 3, 3)},    // lid of the far part
      {Vector3d(0, 3, 0), Vector3d(3, 6, 0.5)},    // floor of the open part
      {Vector3d(0, 3, 2.5), Vector3d(3, 6, 3)},    // ceiling of the open part
      {Vector3d(2.5, 2.5, 0), Vector3d(3, 6, 3)}   // inner wall of the open part
  };
  TriangleMesh mesh;
  for (const AlignedBox3d& wall : walls) mesh = joined(mesh, box_mesh(wall.min(), wall.max()));
  return mesh;
}

TEST(ExternalReach, EverySphereCanBeReachedFromOutside) {
  for (const TriangleMesh& mesh : effort(std::vector{pipe(2, 1.6, 4, 12), bent_duct()}, 1)) {
    for (const ExternalPlacement placement : kPlacements) {
      const ExternalSpheres external =
          place_external_spheres(mesh, {.placement = placement,
                                        .min_external_diameter = 1.2,
                                        .grid_step = kSanitized ? 0.4 : 0.3,
                                        .limit = samples(800, 200)});
      EXPECT_EQ(reached(mesh, external), external.spheres.size());
    }
  }
}

TEST(ExternalReach, TheFarPartOfADuctIsOpenOnlyWhereTheWayThereIsWide) {
  const auto is_open = [](const TriangleMesh& mesh, ExternalPlacement placement) {
    return !is_in_solid({4.0, 1.5, 1.5}, place_external_spheres(mesh, {.placement = placement,
                                                                       .min_external_diameter = 1.2,
                                                                       .grid_step = 0.2,
                                                                       .limit = 20000}));
  };
  const TriangleMesh duct = bent_duct();
  EXPECT_TRUE(is_open(duct, ExternalPlacement::kReachable));
  // A sill in the open part leaves a way of 1.1: what lies behind is filled.
  const TriangleMesh blocked = joined(duct, box_mesh({0.5, 4.5, 0.5}, {2.5, 4.8, 1.4}));
  for (const ExternalPlacement placement : kPlacements) EXPECT_FALSE(is_open(blocked, placement));
}

// A tool of spheres of diameter at least D and room for the grid, in a position that it reaches
// from outside, intersects S by no more than that room, unless it intersects M.
TEST(ExternalReach, NothingIsLostForToolsOfTheLeastDiameter) {
  Random random(61);
  int tried = 0;
  for (const TriangleMesh& mesh :
       {l_bracket(), pipe(1.0, 0.8, 1.0, 16), torus(1.0, 0.3, 16, 8), cube_mesh()}) {
    const ExternalSpheres external =
        place_external_spheres(mesh, {.min_external_diameter = 0.4, .grid_step = 0.05});
    // With so much room the place's own cell is reached, and its sphere is known up to that.
    const double slack = 2.0 * (0.8661 + 0.5) * external.grid_step;
    const double rho = (external.min_external_diameter + slack) / 2.0;
    const Vector3d margin = Vector3d::Constant(0.5);
    const AlignedBox3d field(external.box.min() - margin, external.box.max() + margin);
    for (int i = 0; i < effort(1500, 200); ++i) {
      const Vector3d c = random.in_box(field);
      const auto room = static_cast<double>(judged_mesh_distance(c, mesh));
      if (room < rho || !leaves(mesh, external.box, c, rho)) continue;
      const double radius = std::min(room, random.between(rho, 3.0 * rho));
      ++tried;
      for (int k = 0; k < 20; ++k) {
        const double share = k % 2 == 0 ? 1.0 : random.unit();
        const Vector3d p = c + share * (radius - slack) * random.direction();
        ASSERT_FALSE(is_in_solid(p, external));
      }
    }
  }
  EXPECT_GT(tried, effort(1500, 200) / 2);
}

}  // namespace
}  // namespace spherule::test
