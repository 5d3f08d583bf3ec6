// SPDX-License-Identifier: BSD-3-Clause
// The flood of stage 1. What is wider than D by the closing slack is open (G2): chambers behind
// ways whose width is known, and places among random blocks to which a finer flood of exact
// distances gets, in zones of a smaller D too. Large spheres stand for the finest cells beside
// surfaces. External spheres are free of the padded mesh, and only where a tool of the least
// diameter can get.
#include "simplifier/simplify.h"
#include "simplifier/types/zones.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

Eigen::Isometry3d random_pose(Random& random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = random.rotation().toRotationMatrix();
  pose.translation() = 0.3 * random.direction();
  return pose;
}

// A flood of its own: nodes of a grid whose exact distance leaves room for a sphere, from node to
// node where the sphere provably passes. The radius that it has to have follows the place, and is
// on a segment no more than the greater of those at its ends.
class FineFlood {
 public:
  // `radius_at(place)` is at most `greatest`.
  template <typename Radius>
  FineFlood(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box, double step, double greatest,
            Radius radius_at)
      : step_(step), origin_(box.min() - Eigen::Vector3d::Constant(2.0 * greatest)) {
    const Eigen::Vector3d size = box.sizes() + Eigen::Vector3d::Constant(4.0 * greatest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<int>(std::ceil(size[static_cast<int>(axis)] / step)) + 1;
    }
    for_each_node([&](int i, int j, int k) {
      clearance_.push_back(static_cast<double>(judged_mesh_distance(at(i, j, k), mesh)));
      radius_.push_back(radius_at(at(i, j, k)));
    });
    flood();
  }

  template <typename Visit>
  void for_each_reached(Visit visit) const {
    for_each_node([&](int i, int j, int k) {
      if (reached_[index(i, j, k)]) visit(at(i, j, k));
    });
  }

 private:
  template <typename Visit>
  void for_each_node(Visit visit) const {
    for (int k = 0; k < count_[2]; ++k) {
      for (int j = 0; j < count_[1]; ++j) {
        for (int i = 0; i < count_[0]; ++i) visit(i, j, k);
      }
    }
  }
  Eigen::Vector3d at(int i, int j, int k) const {
    return origin_ + step_ * Eigen::Vector3d(i, j, k);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i);
  }
  void flood() {
    reached_.assign(radius_.size(), false);
    std::vector<std::array<int, 3>> front{{0, 0, 0}};
    reached_[0] = true;
    while (!front.empty()) {
      const std::array<int, 3> here = front.back();
      front.pop_back();
      const std::size_t from = index(here[0], here[1], here[2]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int by : {-1, 1}) {
          std::array<int, 3> next = here;
          next[axis] += by;
          if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
          const std::size_t there = index(next[0], next[1], next[2]);
          const double radius = std::max(radius_[from], radius_[there]);
          const double least = (clearance_[from] + clearance_[there] - step_) / 2.0;
          if (reached_[there] || clearance_[there] < radius_[there] || least < radius) continue;
          reached_[there] = true;
          front.push_back(next);
        }
      }
    }
  }

  double step_;
  Eigen::Vector3d origin_;
  std::array<int, 3> count_{};
  std::vector<double> clearance_;  // of each node, as the others
  std::vector<double> radius_;
  std::vector<bool> reached_;
};

// Blocks that stand close to each other, with gaps around D.
TriangleMesh random_blocks(Random& random) {
  TriangleMesh mesh;
  for (int n = 0; n < 9; ++n) {
    const Eigen::Vector3d low = 1.6 * random.unit() * random.direction();
    const Eigen::Vector3d size(random.between(0.2, 1.4), random.between(0.2, 1.4),
                               random.between(0.2, 1.4));
    const TriangleMesh block = moved(box_mesh(low, low + size), random_pose(random));
    mesh = n == 0 ? block : joined(mesh, block);
  }
  return mesh;
}

bool is_in_a_sphere(const ExternalSpheres& external, const Vector3d& place) {
  return std::ranges::any_of(external.spheres, [&](const Sphere& sphere) {
    return (sphere.center - place).norm() < sphere.radius;
  });
}

// --- ways that are hardly wider than D, which is 1 ---

// A closed chamber of the inner half-widths 1.2, its walls 0.2 thick, with a square way in of the
// given width and length through the wall at x = 1.2: a sphere gets in exactly if it is no wider.
TriangleMesh chamber(double width, double length) {
  constexpr double kHalf = 1.2;
  constexpr double kOuter = kHalf + 0.2;
  const double half = width / 2.0;
  const std::vector<AlignedBox3d> walls = {
      {Vector3d(-kOuter, -kOuter, -kOuter), Vector3d(-kHalf, kOuter, kOuter)},
      {Vector3d(-kHalf, -kOuter, -kOuter), Vector3d(kHalf, -kHalf, kOuter)},
      {Vector3d(-kHalf, kHalf, -kOuter), Vector3d(kHalf, kOuter, kOuter)},
      {Vector3d(-kHalf, -kHalf, -kOuter), Vector3d(kHalf, kHalf, -kHalf)},
      {Vector3d(-kHalf, -kHalf, kHalf), Vector3d(kHalf, kHalf, kOuter)},
      // Around the way.
      {Vector3d(kHalf, -kOuter, -kOuter), Vector3d(kHalf + length, -half, kOuter)},
      {Vector3d(kHalf, half, -kOuter), Vector3d(kHalf + length, kOuter, kOuter)},
      {Vector3d(kHalf, -half, -kOuter), Vector3d(kHalf + length, half, -half)},
      {Vector3d(kHalf, -half, half), Vector3d(kHalf + length, half, kOuter)}};
  TriangleMesh mesh;
  for (const AlignedBox3d& wall : walls) mesh = joined(mesh, box_mesh(wall.min(), wall.max()));
  return mesh;
}

// Whether the middle of the chamber is filled.
struct Chamber {
  double step;
  double tightness;
  double length;
  Eigen::Isometry3d pose;

  ExternalSpheres placed(double width) const {
    return place_external_spheres(
        moved(chamber(width, length), pose),
        {.min_external_diameter = 1.0, .grid_step = step, .tightness = tightness});
  }
  bool is_filled(const ExternalSpheres& external) const {
    return is_in_solid(pose.translation(), external);
  }
};

TEST(TightReach, AChamberIsOpenExactlyIfItsWayIsWideEnough) {
  Random random(71);
  for (int n = 0; n < effort(12, 2); ++n) {
    const double step = n % 3 == 0 ? 0.125 : n % 3 == 1 ? 0.1 : 0.07;
    const double tightness = n % 4 == 0 ? 0.01 : 0.03;
    const double length = n % 2 == 0 ? 0.02 : random.between(0.02, 1.5);
    const Chamber closed_room{step, tightness, length, random_pose(random)};
    const ExternalSpheres wide = closed_room.placed(1.0 + tightness + 1e-9);
    EXPECT_LE(wide.closing_slack, tightness * (1.0 + 1e-12));
    EXPECT_FALSE(closed_room.is_filled(wide)) << n;
    EXPECT_TRUE(closed_room.is_filled(closed_room.placed(1.0 - 1e-9))) << n;
  }
}

// The grid alone leaves such a chamber closed.
TEST(TightReach, TheGridAloneIsNotTight) {
  Random random(72);
  int closed = 0;
  for (int n = 0; n < effort(6, 2); ++n) {
    const Chamber closed_room{0.125, ExternalOptions::kNoTightness, 0.5, random_pose(random)};
    const ExternalSpheres external = closed_room.placed(1.03);
    EXPECT_NEAR(external.closing_slack, 2.7322 * 0.125, 1e-3);
    closed += closed_room.is_filled(external) ? 1 : 0;
  }
  EXPECT_GT(closed, 0);
}

// Every place lies in a sphere whose centre is within 2.6 steps, or of what its radius is above D
// / 2.
TEST(TightReach, NoPlaceAmongBlocksIsLost) {
  Random random(73);
  std::size_t narrow = 0;
  for (int n = 0; n < effort(2, 1); ++n) {
    const TriangleMesh mesh = random_blocks(random);
    const ExternalSpheres external =
        place_external_spheres(mesh, {.min_external_diameter = 1.0, .grid_step = 0.12});
    ASSERT_LE(external.closing_slack, 0.03 * (1.0 + 1e-12));
    const double radius = 0.5 * (1.0 + external.closing_slack);
    FineFlood(mesh, external.box, kSanitized ? 0.2 : 0.1, radius, [&](const Vector3d&) {
      return radius;
    }).for_each_reached([&](const Vector3d& place) {
      if (external.box.exteriorDistance(place) > 0.0) return;
      ++narrow;
      const bool is_near = std::ranges::any_of(external.spheres, [&](const Sphere& sphere) {
        const double distance = (sphere.center - place).norm();
        return distance < sphere.radius && distance <= 2.6 * std::max(0.12, sphere.radius - 0.5);
      });
      ASSERT_TRUE(is_near);
    });
  }
  EXPECT_GT(narrow, 30U);
}

// --- borders of zones ---
// Ways into zones of a smaller D: none is lost, and where a zone ends at D / 2 from a surface, so
// that spheres of D just do not get in, the search for the way ends.

constexpr double kTightness = 0.03;

ExternalSpheres placed(const TriangleMesh& mesh, double diameter, double step,
                       const std::vector<Zone>& zones) {
  return place_external_spheres(mesh, {.min_external_diameter = diameter,
                                       .grid_step = step,
                                       .tightness = kTightness,
                                       .zones = zones});
}

// How many of the places in zones that a sphere gets to which is larger by the slack lie in the
// box, each in an external sphere.
std::size_t places_in_zones(const TriangleMesh& mesh, const ExternalSpheres& external,
                            const std::vector<Zone>& zones, double step) {
  const double share = 1.0 + external.closing_slack / external.min_external_diameter;
  const double greatest = 0.5 * share * external.min_external_diameter;
  const auto in_zone = [](const Vector3d& place) {
    return [&](const Zone& zone) { return zone_distance(zone.shape, place) == 0.0L; };
  };
  const auto radius_at = [&](const Vector3d& place) {
    double radius = greatest;
    for (const Zone& zone : zones) {
      if (in_zone(place)(zone)) {
        radius = std::min(radius, 0.5 * share * zone.min_external_diameter.value());
      }
    }
    return radius;
  };
  std::size_t count = 0;
  FineFlood(mesh, external.box, step, greatest, radius_at)
      .for_each_reached([&](const Vector3d& place) {
        if (external.box.exteriorDistance(place) > 0.0) return;
        count += std::ranges::any_of(zones, in_zone(place)) ? 1 : 0;
        EXPECT_TRUE(is_in_a_sphere(external, place)) << place.transpose();
      });
  return count;
}

TEST(ZoneBorder, NoPlaceBesideOneIsLost) {
  Random random(75);
  std::size_t narrow = 0;
  for (int n = 0; n < effort(5, 1); ++n) {
    const TriangleMesh mesh = random_blocks(random);
    const Vector3d middle = 1.2 * random.unit() * random.direction();
    const double size = random.between(0.4, 1.2);
    const ZoneShape shape =
        n % 2 == 0
            ? ZoneShape(Sphere{middle, size})
            : ZoneShape(AlignedBox3d(middle - Vector3d::Constant(size),
                                     middle + Vector3d(size, random.between(0.2, 1.2), size)));
    const std::vector<Zone> zones = {
        {.shape = shape, .min_external_diameter = random.between(0.35, 0.8)}};
    const ExternalSpheres external = placed(mesh, 1.0, 0.12, zones);
    narrow += places_in_zones(mesh, external, zones, kSanitized ? 0.2 : 0.08);
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(narrow, static_cast<std::size_t>(effort(50, 1)));
}

// Halving cells shows nothing there: it went on until memory ended.
TEST(ZoneBorder, AtHalfADiameterFromASurfaceTheSearchEnds) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  constexpr double kDiameter = 4.0;
  const TriangleMesh block = box_mesh({0, 0, 0}, {10, 10, 10});
  for (const ZoneShape& shape :
       {ZoneShape(AlignedBox3d(Vector3d(3, 3, 5), Vector3d(7, 7, 10.0 + kDiameter / 2.0))),
        ZoneShape(Sphere{Vector3d::Zero(), kDiameter / 2.0})}) {
    const ExternalSpheres external =
        placed(block, kDiameter, 0.4, {{.shape = shape, .min_external_diameter = 1.0}});
    EXPECT_EQ(external.closing_slack, kTightness * kDiameter);
    EXPECT_LT(external.nodes_examined, 1000000U);
  }
}

// Of a ball about a corner, beside which the way of the larger sphere along the border is long.
TEST(ZoneBorder, ALongBorderIsFollowedToItsEnd) {
  const Vector3d corner(1.8692347497298332, 1.8538621497110468, 0.87688810503765979);
  const TriangleMesh mesh = joined(
      joined(box_mesh({0.47556057437192245, 0.6539228147908045, 0.34505270004082561}, corner),
             box_mesh({-0.413413374000901, -0.49420333538120342, -0.18814292867191337},
                      {0.46895134757748086, 0.72679422644759906, 0.25346337387765083})),
      box_mesh({0.080069186767595654, -0.14610412349455482, 0.0061430038422198409},
               {0.60415015232072988, 0.55903746388034936, 0.99559841005211114}));
  const Zone ball{.shape = Sphere{corner, 0.5}, .min_external_diameter = 0.61536468020448976};
  const ExternalSpheres external = place_external_spheres(
      mesh, {.min_external_diameter = 1.0, .grid_step = 0.125, .tightness = 0.08, .zones = {ball}});
  EXPECT_EQ(external.closing_slack, 0.08);
}

// --- large spheres that stand for the finest cells beside flat and convex surfaces ---

const ExternalOptions kFine{.min_external_diameter = 0.05, .max_error = 0.0125};

// A turned cube of side 1, whose faces are none of its box.
Eigen::Isometry3d turn() {
  return Eigen::Isometry3d(Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()));
}
TriangleMesh turned_cube() {
  return moved(cube_mesh(), turn());
}

// As many cells as a uniform grid takes for three layers beside the cube, instead of some seven.
TEST(SphereOfPlaces, FewCellsAndSpheresAreNeededBesideFlatFaces) {
  const ExternalSpheres external = place_external_spheres(turned_cube(), kFine);
  const double one_layer = 6.0 / (external.grid_step * external.grid_step);
  EXPECT_LT(static_cast<double>(external.nodes_examined), 3.0 * one_layer);
  EXPECT_LT(static_cast<double>(external.spheres.size()), one_layer);
}

// Near a face, S ends where it does with the finest cells.
TEST(SphereOfPlaces, TheyLeaveNoHigherScallops) {
  Random random(82);
  const ExternalSpheres external = place_external_spheres(turned_cube(), kFine);
  const Vector3d normal = turn().linear() * Vector3d::UnitZ();
  double highest = 0.0;
  for (int n = 0; n < effort(400, 50); ++n) {
    const Vector3d on_face(random.between(0.1, 0.9), random.between(0.1, 0.9), 1.0);
    const Vector3d foot = turn() * on_face;
    double height = 0.0;
    while (is_in_solid(foot + height * normal, external)) height += 0.002 * kFine.max_error;
    highest = std::max(highest, height);
  }
  EXPECT_LT(highest, 0.032 * kFine.max_error);
}

// The mesh that is its own box: nothing is taken from it, and nothing has to be kept for it.
TEST(SphereOfPlaces, ABoxNeedsNoExternalSpheres) {
  for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(0.1, 1e3, -1e3)}) {
    const ExternalSpheres external =
        place_external_spheres(box_mesh(at, at + Vector3d(1.0, 0.7, 0.3)), kFine);
    EXPECT_TRUE(external.spheres.empty());
    EXPECT_LE(external.closing_slack, 0.03 * kFine.min_external_diameter * (1.0 + 1e-12));
  }
}

// The large sphere in front of a zone needs more room on its way than in the zone.
TEST(SphereOfPlaces, AZoneThatNothingReachesEndsTheSearch) {
  ExternalOptions options{.min_external_diameter = 1.0, .max_error = 0.1};
  options.zones = {{.shape = Sphere{{3.03, 3.01, 1.02}, 0.46}, .min_external_diameter = 0.25}};
  const ExternalSpheres external = place_external_spheres(box_mesh({0, 0, 0}, {6, 6, 1}), options);
  EXPECT_LE(external.closing_slack, 0.03 * (1.0 + 1e-12));
}

// Equal bits on every machine and any number of threads (G7). The corners are exact.
TEST(SphereOfPlaces, AreEqualEverywhere) {
  const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  ExternalOptions options = kFine;
  for (const int threads : {1, 4}) {
    options.threads = threads;
    const std::uint64_t hash = hash_of(place_external_spheres(tetrahedron, options).spheres);
    EXPECT_EQ(hash, 0x01bca525a8fe7f5dU) << "0x" << std::hex << hash;
  }
}

// --- external spheres of both placements ---

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

TEST(ExternalSpheres, SaysWhetherAModelIsTooLargeOrTooFarFromItsOrigin) {
  const auto said = [](double from, double size) {
    const TriangleMesh mesh = box_mesh(Vector3d::Constant(from), Vector3d::Constant(from + size));
    return refusal([&] { place_external_spheres(mesh, of_diameter(0.04)); });
  };
  EXPECT_NE(said(1e8, 0.1).find("with coordinates of up to 1e+08"), std::string::npos);
  EXPECT_NE(said(0.0, 1e8).find("steps wide: fit it in parts"), std::string::npos);
  EXPECT_EQ(said(1e4, 0.1), "accepted");
}

// --- reach ---

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

}  // namespace
}  // namespace spherule::test
