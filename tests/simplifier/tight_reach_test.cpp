// SPDX-License-Identifier: BSD-3-Clause
// What is wider than D by the closing slack is open: chambers behind ways whose width is known, and
// places among random blocks to which a finer flood of exact distances gets.
#include "simplifier/external_spheres.h"
#include "spheretree/error.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace spherule::test::tight_reach_test {
namespace {

using Eigen::Vector3d;

constexpr double kDiameter = 1.0;

Eigen::Isometry3d random_pose(Random& random) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = random.rotation().toRotationMatrix();
  pose.translation() = 0.3 * random.direction();
  return pose;
}

// A closed chamber of the inner half-widths 1.2, its walls 0.2 thick, with a square way in of the
// given width and length through the wall at x = 1.2: a sphere gets in exactly if it is no wider.
TriangleMesh chamber(double width, double length) {
  constexpr double kHalf = 1.2;
  constexpr double kOuter = kHalf + 0.2;
  const double half = width / 2.0;
  TriangleMesh mesh = box_mesh({-kOuter, -kOuter, -kOuter}, {-kHalf, kOuter, kOuter});
  const auto add = [&](const Vector3d& low, const Vector3d& high) {
    mesh = joined(mesh, box_mesh(low, high));
  };
  add({-kHalf, -kOuter, -kOuter}, {kHalf, -kHalf, kOuter});
  add({-kHalf, kHalf, -kOuter}, {kHalf, kOuter, kOuter});
  add({-kHalf, -kHalf, -kOuter}, {kHalf, kHalf, -kHalf});
  add({-kHalf, -kHalf, kHalf}, {kHalf, kHalf, kOuter});
  // Around the way.
  add({kHalf, -kOuter, -kOuter}, {kHalf + length, -half, kOuter});
  add({kHalf, half, -kOuter}, {kHalf + length, kOuter, kOuter});
  add({kHalf, -half, -kOuter}, {kHalf + length, half, -half});
  add({kHalf, -half, half}, {kHalf + length, half, kOuter});
  return mesh;
}

// Grids of other steps, and what is queried of them.
ExternalOptions options_for(double step, double tightness) {
  ExternalOptions options;
  options.min_external_diameter = kDiameter;
  options.grid_step = step;
  options.tightness = tightness;
  return options;
}

TEST(TightReach, AChamberIsOpenExactlyIfItsWayIsWideEnough) {
  Random random(71);
  for (int n = 0; n < effort(12, 2); ++n) {
    const double step = n % 3 == 0 ? 0.125 : n % 3 == 1 ? 0.1 : 0.07;
    const double tightness = n % 4 == 0 ? 0.01 : 0.03;
    const double length = n % 2 == 0 ? 0.02 : random.between(0.02, 1.5);
    const Eigen::Isometry3d pose = random_pose(random);
    const Vector3d inside = pose.translation();
    const ExternalOptions options = options_for(step, tightness);
    const auto placed = [&](double width) {
      return place_external_spheres(moved(chamber(width, length), pose), options);
    };
    const ExternalSpheres wide = placed(kDiameter * (1.0 + tightness) + 1e-9);
    EXPECT_LE(wide.closing_slack, tightness * kDiameter * (1.0 + 1e-12));
    EXPECT_FALSE(is_in_solid(inside, wide)) << n;
    EXPECT_TRUE(is_in_solid(inside, placed(kDiameter * (1.0 - 1e-9)))) << n;
  }
}

// The grid alone leaves such a chamber closed.
TEST(TightReach, TheGridAloneIsNotTight) {
  Random random(72);
  int closed = 0;
  for (int n = 0; n < effort(6, 2); ++n) {
    const Eigen::Isometry3d pose = random_pose(random);
    const ExternalSpheres external = place_external_spheres(
        moved(chamber(1.03, 0.5), pose), options_for(0.125, ExternalOptions::kNoTightness));
    EXPECT_NEAR(external.closing_slack, 2.7322 * 0.125, 1e-3);
    closed += is_in_solid(pose.translation(), external) ? 1 : 0;
  }
  EXPECT_GT(closed, 0);
}

// A flood of its own: nodes of a grid whose exact distance leaves room for a sphere, from node to
// node where the sphere provably passes.
class FineFlood {
 public:
  FineFlood(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box, double step, double radius)
      : step_(step), origin_(box.min() - Vector3d::Constant(2.0 * radius)) {
    const Vector3d size = box.sizes() + Vector3d::Constant(4.0 * radius);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] = static_cast<int>(std::ceil(size[static_cast<int>(axis)] / step)) + 1;
    }
    for_each_node([&](int i, int j, int k) {
      room_.push_back(static_cast<double>(judged_mesh_distance(at(i, j, k), mesh)) - radius);
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
  Vector3d at(int i, int j, int k) const { return origin_ + step_ * Vector3d(i, j, k); }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>((k * count_[1] + j) * count_[0] + i);
  }
  void flood() {
    reached_.assign(room_.size(), false);
    std::vector<std::array<int, 3>> front{{0, 0, 0}};
    reached_[0] = true;
    while (!front.empty()) {
      const std::array<int, 3> here = front.back();
      front.pop_back();
      const double room = room_[index(here[0], here[1], here[2])];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int by : {-1, 1}) {
          std::array<int, 3> next = here;
          next[axis] += by;
          if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
          const std::size_t there = index(next[0], next[1], next[2]);
          if (reached_[there] || room_[there] < 0.0 || room + room_[there] < step_) continue;
          reached_[there] = true;
          front.push_back(next);
        }
      }
    }
  }

  double step_;
  Vector3d origin_;
  std::array<int, 3> count_{};
  std::vector<double> room_;  // of each node
  std::vector<bool> reached_;
};

// Blocks that stand close to each other, with gaps around D.
TriangleMesh random_blocks(Random& random) {
  TriangleMesh mesh;
  for (int n = 0; n < 9; ++n) {
    const Vector3d low = 1.6 * random.unit() * random.direction();
    const Vector3d size(random.between(0.2, 1.4), random.between(0.2, 1.4),
                        random.between(0.2, 1.4));
    const TriangleMesh block = moved(box_mesh(low, low + size), random_pose(random));
    mesh = n == 0 ? block : joined(mesh, block);
  }
  return mesh;
}

// Every place lies in a sphere whose centre is within 2.6 steps, or of what its radius is above D
// / 2.
TEST(TightReach, NoPlaceAmongBlocksIsLost) {
  Random random(73);
  std::size_t narrow = 0;
  for (int n = 0; n < effort(2, 1); ++n) {
    const TriangleMesh mesh = random_blocks(random);
    const ExternalOptions options = options_for(0.12, 0.03);
    const ExternalSpheres external = place_external_spheres(mesh, options);
    ASSERT_LE(external.closing_slack, 0.03 * (1.0 + 1e-12));
    const double radius = 0.5 * (kDiameter + external.closing_slack);
    FineFlood(mesh, external.box, kSanitized ? 0.2 : 0.1, radius)
        .for_each_reached([&](const Vector3d& place) {
          if (external.box.exteriorDistance(place) > 0.0) return;
          ++narrow;
          const bool is_near = std::ranges::any_of(external.spheres, [&](const Sphere& sphere) {
            const double distance = (sphere.center - place).norm();
            return distance < sphere.radius &&
                   distance <= 2.6 * std::max(0.12, sphere.radius - 0.5);
          });
          ASSERT_TRUE(is_near);
        });
  }
  EXPECT_GT(narrow, 30U);
}

TEST(TightReach, BadTightnessIsRefused) {
  for (const double tightness : {0.0, -1.0, 11.0, std::nan("")}) {
    EXPECT_THROW(place_external_spheres(cube_mesh(), options_for(0.1, tightness)), Error);
  }
}

}  // namespace
}  // namespace spherule::test::tight_reach_test
