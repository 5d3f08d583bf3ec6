// SPDX-License-Identifier: BSD-3-Clause
// Cells of joint positions in which two bodies are apart, against the gaps of all their spheres.

#include "collide/kernels/plan_trees.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace spherule::test::free_cells_test {
namespace {

using internal::FreeCells;
using internal::FreeCellsSource;
using internal::SearchTrees;

std::shared_ptr<const SearchTrees> trees_of(const std::vector<Sphere>& spheres) {
  return std::make_shared<const SearchTrees>(spheres);
}

FreeCellsSource::Joint random_joint(Random& random, int position) {
  FreeCellsSource::Joint joint{random.pose(0.5), random.whole(0, 3) > 0, position};
  const double span = joint.turns ? 1.0 : 0.2;
  joint.lower = random.between(-3.2, 0.0) * span;
  joint.upper = joint.lower + random.between(0.0, 6.4) * span;
  if (random.whole(0, 9) == 0) joint.upper = joint.lower;
  if (random.whole(0, 9) == 0) joint.upper = joint.lower + 12.6 * span;
  return joint;
}

// One or two joints, on either side.
FreeCellsSource random_source(Random& random) {
  FreeCellsSource source;
  const int joints = random.whole(1, 2);
  for (int i = 0; i < joints; ++i) {
    FreeCellsSource::Side& side = random.whole(0, 1) == 0 ? source.first : source.second;
    side.chain.push_back(random_joint(random, i));
  }
  for (FreeCellsSource::Side* side : {&source.first, &source.second}) {
    side->trees = trees_of(random_spheres(random, random.whole(1, 30), 0.3, 0.1));
    side->frame_from_trees = random.pose(0.4);
  }
  source.margin = random.whole(0, 1) * 1e-3;
  return source;
}

Eigen::Isometry3d pose_of(const FreeCellsSource::Side& side, const std::vector<double>& positions) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (const FreeCellsSource::Joint& joint : side.chain) {
    const double at = positions[static_cast<std::size_t>(joint.position)];
    result = result * joint.parent_from_frame.isometry();
    if (joint.turns) {
      result.rotate(Eigen::AngleAxisd(at, Eigen::Vector3d::UnitZ()));
    } else {
      result.translate(at * Eigen::Vector3d::UnitZ());
    }
  }
  return result * side.frame_from_trees.isometry();
}

// Of the nearest two spheres.
double gap(const FreeCellsSource& source, const std::vector<double>& positions) {
  const Eigen::Isometry3d first = pose_of(source.first, positions);
  const Eigen::Isometry3d second = pose_of(source.second, positions);
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& a : source.first.trees->narrow.spheres()) {
    for (const Sphere& b : source.second.trees->narrow.spheres()) {
      least = std::min(least, (first * a.center - second * b.center).norm() - a.radius - b.radius);
    }
  }
  return least;
}

bool is_free(const FreeCells& cells, const std::vector<double>& positions) {
  int coordinates[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const FreeCells::Axis& axis = cells.axes()[k];
    const double at =
        (positions[static_cast<std::size_t>(axis.position)] - axis.lower) * axis.scale;
    if (!(at >= 0.0 && at < FreeCells::kCells)) return false;
    coordinates[k] = static_cast<int>(at);
  }
  return (cells.words()[static_cast<std::size_t>(coordinates[1])] >> coordinates[0] & 1U) != 0;
}

// Anywhere in the intervals, or at a border between two cells: there the bound is least slack.
std::vector<double> random_positions(Random& random, const FreeCellsSource& source,
                                     const FreeCells& cells) {
  std::vector<double> positions(2, 0.0);
  for (const FreeCellsSource::Side* side : {&source.first, &source.second}) {
    for (const FreeCellsSource::Joint& joint : side->chain) {
      double& at = positions[static_cast<std::size_t>(joint.position)];
      at = random.between(joint.lower, joint.upper);
      for (const FreeCells::Axis& axis : cells.axes()) {
        if (axis.position != joint.position || axis.scale == 0.0 || random.whole(0, 1) == 0) {
          continue;
        }
        at = axis.lower + random.whole(0, FreeCells::kCells) / axis.scale;
        at = std::clamp(at + random.whole(-1, 1) * 1e-15, joint.lower, joint.upper);
      }
    }
  }
  return positions;
}

TEST(FreeCells, HoldNoPositionsAtWhichSpheresAreNear) {
  Random random(seeded(77));
  int checked = 0;
  int far = 0;
  int far_and_free = 0;
  for (int round = 0; round < scaled(300, 60); ++round) {
    const FreeCellsSource source = random_source(random);
    const std::shared_ptr<const FreeCells> cells = FreeCells::of(source);
    if (cells == nullptr) continue;
    for (int i = 0; i < 400; ++i) {
      const std::vector<double> positions = random_positions(random, source, *cells);
      const double exact = gap(source, positions);
      const bool free = is_free(*cells, positions);
      if (free) {
        ASSERT_GT(exact, source.margin) << "round " << round;
      }
      checked += free ? 1 : 0;
      far += exact > 0.1 ? 1 : 0;
      far_and_free += exact > 0.1 && free ? 1 : 0;
    }
  }
  EXPECT_GT(checked, effort(20000, 4000));
  EXPECT_GT(far_and_free, far / 10 * 9);
}

TEST(FreeCells, AreNoneWhereNothingIsFreeOrNothingOrTooMuchMoves) {
  Random random(seeded(5));
  FreeCellsSource source = random_source(random);
  source.first.chain = {random_joint(random, 0)};
  source.second.chain = {random_joint(random, 1), random_joint(random, 2)};
  EXPECT_EQ(FreeCells::of(source), nullptr);
  source.first.chain.clear();
  source.second.chain.clear();
  EXPECT_EQ(FreeCells::of(source), nullptr);
  source.second.chain = {{Pose(), false, 0, -1e300, 1e300}};
  EXPECT_EQ(FreeCells::of(source), nullptr);
  source.second.chain = {{Pose(), true, 0, -1.0, 1.0}};
  source.first.trees = trees_of({{Eigen::Vector3d::Zero(), 100.0}});
  EXPECT_EQ(FreeCells::of(source), nullptr);
}

TEST(FreeCells, AreKeptForTheSameTreesAndJoints) {
  Random random(seeded(6));
  internal::FreeCellsCache cache;
  FreeCellsSource source;
  source.first.trees = trees_of({{Eigen::Vector3d::Zero(), 0.1}});
  source.second.trees = trees_of({{Eigen::Vector3d::UnitX(), 0.1}});
  source.second.chain = {{Pose(), true, 0, -1.0, 1.0}};
  const std::shared_ptr<const FreeCells> cells = cache.of(source);
  ASSERT_NE(cells, nullptr);
  EXPECT_EQ(cache.of(source), cells);
  FreeCellsSource other = source;
  other.second.chain[0].upper = 2.0;
  EXPECT_NE(cache.of(other), cells);
  other = source;
  other.second.frame_from_trees = Pose::from_translation({-1.0, 0.0, 0.0});
  EXPECT_EQ(cache.of(other), nullptr);
  other = source;
  other.second.trees = trees_of({{Eigen::Vector3d::Zero(), 0.1}});
  EXPECT_EQ(cache.of(other), nullptr);
  EXPECT_EQ(cache.of(source), cells);
}

}  // namespace
}  // namespace spherule::test::free_cells_test
