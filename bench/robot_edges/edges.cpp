// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/edges.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace spherule {
namespace {

// Of any joint.
double largest_change(const Edge& edge) {
  double largest = 0.0;
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    largest = std::max(largest, std::abs(edge.to[i] - edge.from[i]));
  }
  return largest;
}

// The numbers from 1 to `steps`, the last one first and then halves of what is left.
std::vector<int> spread_out(int steps) {
  std::vector<int> order = {steps};
  std::vector<std::pair<int, int>> ranges = {{1, steps - 1}};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto [first, last] = ranges[i];
    if (first > last) continue;
    const int middle = (first + last) / 2;
    order.push_back(middle);
    ranges.emplace_back(first, middle - 1);
    ranges.emplace_back(middle + 1, last);
  }
  return order;
}

}  // namespace

Configuration random_configuration(const RobotModel& robot, RandomNumbers& random) {
  Configuration result;
  for (const int joint : robot.variable_joints()) {
    const Joint& moved = robot.joints()[static_cast<std::size_t>(joint)];
    result.push_back(random.between(moved.lower, moved.upper));
  }
  return result;
}

Edge random_edge(const RobotModel& robot, RandomNumbers& random) {
  Edge edge{random_configuration(robot, random), random_configuration(robot, random)};
  const double part = std::min(1.0, random.between(0.1, 1.5) / largest_change(edge));
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    edge.to[i] = edge.from[i] + part * (edge.to[i] - edge.from[i]);
  }
  return edge;
}

std::vector<Configuration> samples(const Edge& edge, double step) {
  const int steps = std::max(1, static_cast<int>(std::ceil(largest_change(edge) / step)));
  std::vector<Configuration> result;
  for (const int k : spread_out(steps)) {
    const double t = static_cast<double>(k) / steps;
    Configuration& at = result.emplace_back(edge.from.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = (1.0 - t) * edge.from[i] + t * edge.to[i];
    }
  }
  return result;
}

}  // namespace spherule
