// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/plan_source.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/link_pieces.h"
#include "tests/robot/check/checked.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

// Queries of trees of boxes and the cells made of them, against the list of their free leaves.

namespace spherule::test::free_boxes_test {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// Often one half alone is halved on: boxes get as thin as rounding.
void add_nodes(Random& random, int variables, int depth, std::string& nodes) {
  if (depth == 0 || random.whole(0, 9) == 0) {
    nodes += static_cast<char>(random.whole(0, 2) == 0 ? FreeBoxes::kNotProved : FreeBoxes::kFree);
    return;
  }
  nodes += static_cast<char>(FreeBoxes::kFirstHalving + random.whole(0, variables - 1));
  const int deeper = random.whole(0, 2);
  add_nodes(random, variables, deeper == 0 ? std::min(depth - 1, 1) : depth - 1, nodes);
  add_nodes(random, variables, deeper == 1 ? std::min(depth - 1, 1) : depth - 1, nodes);
}

struct Leaf {
  std::vector<double> lower;
  std::vector<double> upper;
};

struct Case {
  FreeBoxes boxes;
  std::vector<Leaf> free;
  std::vector<std::vector<double>> planes;  // of each variable: where boxes end
};

Case random_case(Random& random, int most_variables) {
  std::vector<FreeBoxes::Variable> variables;
  const int count = random.whole(1, most_variables);
  for (int i = 0; i < count; ++i) {
    FreeBoxes::Variable variable{.index = i, .wraps = random.whole(0, 3) == 0};
    variable.lower = variable.wraps ? -std::numbers::pi : random.between(-3.0, 1.0);
    variable.upper = variable.wraps ? std::numbers::pi : variable.lower + random.between(0.01, 3.0);
    variables.push_back(variable);
  }
  std::string nodes;
  // As deep as halvings reach the width of rounding, or less.
  add_nodes(random, count, random.whole(1, 9) * (random.whole(0, 3) == 0 ? 6 : 1), nodes);
  Case result{FreeBoxes(variables, nodes), {}, {}};
  result.planes.resize(variables.size());
  result.boxes.for_each_leaf(
      [&](bool is_free, std::span<const double> lower, std::span<const double> upper) {
        for (std::size_t i = 0; i < lower.size(); ++i) {
          result.planes[i].insert(result.planes[i].end(), {lower[i], upper[i]});
        }
        if (is_free) {
          result.free.push_back({{lower.begin(), lower.end()}, {upper.begin(), upper.end()}});
        }
      });
  return result;
}

// How far a configuration is from the nearest free leaf, in the variable that is farthest.
double distance_to_free(const Case& tested, const Configuration& q) {
  double nearest = 1e9;
  for (const Leaf& leaf : tested.free) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const auto beyond = [&](double value) {
        return std::max({0.0, leaf.lower[i] - value, value - leaf.upper[i]});
      };
      double distance = beyond(q[i]);
      if (tested.boxes.variables()[i].wraps) {
        for (int turns = -3; turns <= 3; ++turns) {
          distance = std::min(distance, beyond(q[i] + turns * kTurn));
        }
      }
      farthest = std::max(farthest, distance);
    }
    nearest = std::min(nearest, farthest);
  }
  return nearest;
}

// In each variable near a plane, by some tolerances or less, or anywhere.
Configuration random_configuration(Random& random, const Case& tested) {
  Configuration q;
  for (std::size_t i = 0; i < tested.planes.size(); ++i) {
    const auto& planes = tested.planes[i];
    const FreeBoxes::Variable& variable = tested.boxes.variables()[i];
    const double step = FreeBoxes::kTolerance * 0.25 * random.whole(-6, 6);
    double value = random.whole(0, 2) == 0
                       ? random.between(variable.lower - 0.1, variable.upper + 0.1)
                       : planes[static_cast<std::size_t>(
                             random.whole(0, static_cast<int>(planes.size()) - 1))] +
                             step;
    if (variable.wraps) value += kTurn * random.whole(-1, 1);
    q.push_back(value);
  }
  return q;
}

// Turns and steps of a quarter of the tolerance are computed with less than this.
constexpr double kRounding = 1e-14;

TEST(FreeBoxesQueries, ConfigurationsAreFreeWithinTheToleranceOfFreeLeaves) {
  Random random(811);
  int free = 0;
  int near = 0;
  for (int n = 0; n < effort(600, 100); ++n) {
    const Case tested = random_case(random, 3);
    for (int k = 0; k < 60; ++k) {
      const Configuration q = random_configuration(random, tested);
      const double distance = distance_to_free(tested, q);
      if (std::abs(distance - FreeBoxes::kTolerance) < kRounding) continue;
      ASSERT_EQ(tested.boxes.contains(q), distance < FreeBoxes::kTolerance) << n << " " << distance;
      free += distance == 0.0 ? 1 : 0;
      near += distance > 0.0 && distance < 1e-12 ? 1 : 0;
    }
  }
  EXPECT_GT(free, 1000 / (kSanitized ? 10 : 1));
  EXPECT_GT(near, 100 / (kSanitized ? 10 : 1));
}

TEST(FreeBoxesQueries, PointsOfFreeEdgesAreFree) {
  Random random(812);
  int free = 0;
  for (int n = 0; n < effort(600, 100); ++n) {
    const Case tested = random_case(random, 3);
    for (int k = 0; k < 30; ++k) {
      const Configuration from = random_configuration(random, tested);
      Configuration to = from;
      for (double& value : to) {
        if (random.whole(0, 3) > 0) value += random.between(-0.5, 0.5);
      }
      if (random.whole(0, 1) == 0) to = random_configuration(random, tested);
      if (!tested.boxes.contains_edge(from, to)) continue;
      free += from != to ? 1 : 0;
      for (int i = 0; i <= 40; ++i) {
        const double t = i / 40.0;
        ASSERT_TRUE(tested.boxes.contains(on_the_way(from, to, t))) << n << " " << t;
      }
    }
  }
  EXPECT_GT(free, 500 / (kSanitized ? 10 : 1));
}

// A cell that is free holds no configuration further than the tolerance from a free leaf, however
// thin the leaves between are.
TEST(FreeBoxesQueries, FreeCellsHoldFreeConfigurations) {
  Random random(813);
  int free = 0;
  int cells_of = 0;
  const std::vector<int> positions{0, 1};
  for (int n = 0; n < effort(600, 100); ++n) {
    const Case tested = random_case(random, 2);
    const std::size_t count = tested.planes.size();
    const auto cells = internal::box_cells(tested.boxes, std::span(positions).first(count));
    if (cells == nullptr) continue;
    ++cells_of;
    for (int k = 0; k < 60; ++k) {
      const Configuration q = random_configuration(random, tested);
      std::array<std::size_t, 2> at{};
      bool is_within = true;
      for (std::size_t v = 0; v < count; ++v) {
        const auto& axis = cells->axes()[v];
        const double coordinate = (q[v] - axis.lower) * axis.scale;
        is_within &= coordinate >= 0.0 && coordinate < internal::FreeCells::kCells;
        at[v] = static_cast<std::size_t>(std::clamp(coordinate, 0.0, 63.0));
      }
      if (!is_within || (cells->words()[at[1]] >> at[0] & 1U) == 0) continue;
      ++free;
      ASSERT_LT(distance_to_free(tested, q), FreeBoxes::kTolerance) << n;
    }
  }
  EXPECT_GT(cells_of, 50 / (kSanitized ? 5 : 1));
  EXPECT_GT(free, 500 / (kSanitized ? 5 : 1));
}

}  // namespace
}  // namespace spherule::test::free_boxes_test

// Corners of hulls, against support functions: the hull of all points lies within a radius of that
// of the corners exactly if no direction has a point that is further than that before all corners.

namespace spherule::test::hull_corners_test {
namespace {

using Eigen::Vector3d;
using internal::hull_corners;
using internal::HullCorners;

long double most_along(const std::vector<Vector3d>& points, const Vector3d& direction) {
  const Eigen::Matrix<long double, 3, 1> n = direction.cast<long double>();
  long double most = -std::numeric_limits<long double>::infinity();
  for (const Vector3d& point : points) most = std::max(most, n.dot(point.cast<long double>()));
  return most / n.norm();
}

std::vector<Vector3d> points_of(int count, const std::function<Vector3d()>& point) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(point());
  return points;
}

TEST(HullCorners, HoldAllPointsUpToTheirRadius) {
  Random random(83);
  const auto sphere = [&] { return random.direction(); };
  const auto inside = [&] { return Vector3d(random.between(0, 1) * random.direction()); };
  const auto rod = [&] {
    const double angle = random.between(0.0, 6.3);
    return Vector3d(0.05 * std::cos(angle), 0.05 * std::sin(angle), random.whole(0, 40) / 20.0);
  };
  const auto plate = [&] { return Vector3d(random.between(0, 1), random.between(0, 1), 0.25); };
  const auto line = [&] { return Vector3d(random.between(0, 1), 0.5, 0.25); };
  const auto far = [&] { return Vector3d(random.direction() + Vector3d(1e6, -2e6, 3e6)); };
  const std::vector<std::function<Vector3d()>> families{sphere, inside, rod, plate, line, far};
  for (const auto& family : families) {
    const std::vector<Vector3d> points = points_of(effort(3000, 400), family);
    for (const double tolerance : {0.1, 0.003}) {
      const HullCorners found = hull_corners(points, tolerance);
      EXPECT_LE(found.radius, tolerance + 1e-7);
      EXPECT_LT(found.corners.size(), points.size());
      for (const Vector3d& corner : found.corners) {
        ASSERT_NE(std::find(points.begin(), points.end(), corner), points.end());
      }
      for (int i = 0; i < effort(2000, 200); ++i) {
        const Vector3d n = i % 2 == 0 ? random.direction()
                                      : points[static_cast<std::size_t>(
                                            random.whole(0, static_cast<int>(points.size()) - 1))] -
                                            points.front() + 1e-3 * random.direction();
        ASSERT_LE(most_along(points, n), most_along(found.corners, n) + found.radius);
      }
    }
  }
}

TEST(HullCorners, AreFew) {
  Random random(84);
  const std::vector<Vector3d> sphere = points_of(5000, [&] { return random.direction(); });
  EXPECT_LT(hull_corners(sphere, 0.01).corners.size(), 700U);
  EXPECT_LT(hull_corners(sphere, 0.1).corners.size(), 100U);
  const std::vector<Vector3d> few(sphere.begin(), sphere.begin() + 50);
  EXPECT_EQ(hull_corners(few, 0.5).corners, few);
  EXPECT_EQ(hull_corners(few, 0.5).radius, 0.0);
}

}  // namespace
}  // namespace spherule::test::hull_corners_test
