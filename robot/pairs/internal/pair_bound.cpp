// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/pair_bound.h"

#include "robot/model/internal/path_reach.h"
#include "robot/pairs/free_boxes.h"
#include "robot/pairs/internal/hull_direction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace spherule::internal {

using Eigen::Vector3d;

PairBound::PairBound(const RobotModel& robot, std::vector<int> joints, double error)
    : robot_(robot), joints_(std::move(joints)), error_(error) {
  for (auto& axes : axes_) axes.resize(joints_.size());
}

void PairBound::place(std::span<const Pose> world_from_link, std::span<const double> half_widths) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(joints_[i])];
    const Pose& pose = world_from_link[static_cast<std::size_t>(joint.child_link)];
    Axis& axis = axes_[0][i];
    axis.direction = pose.matrix() * joint.axis;
    axis.origin = pose.translation();
    axis.turns = joint.turns();
    const double half = half_widths[static_cast<std::size_t>(joint.variable)] + FreeBoxes::kMargin;
    axis.half = joint.mimics < 0 ? half : std::abs(joint.multiplier) * half;
    axis.chord =
        axis.turns ? 2.0 * std::sin(0.5 * std::min(axis.half, std::numbers::pi)) : axis.half;
    axes_[1][joints_.size() - 1 - i] = axis;
  }
}

void PairBound::losses(std::size_t side, const Vector3d& p, double spread, const Vector3d& n,
                       Losses& loss) const {
  double first_order = 0.0;
  double bend = 0.0;
  double paths = 0.0;  // sum of h r
  double telescope = 0.0;
  loss[0] = 0.0;
  for (std::size_t i = 0; i < axes_[side].size(); ++i) {
    const Axis& axis = axes_[side][i];
    double distance = 1.0;
    double reach = 1.0;
    double along = 0.0;
    if (axis.turns) {
      const Vector3d way = axis.direction.cross(p - axis.origin);
      distance = std::max(way.norm() + spread, 0.0) + 8.0 * error_;
      reach = distance + telescope;
      along = std::max(std::abs(n.dot(way)) + spread, 0.0);
      bend += axis.half * (0.5 * axis.half * reach + paths);
    } else {
      along = std::abs(n.dot(axis.direction));
    }
    first_order += axis.half * (along + 8.0 * error_);
    paths += axis.half * reach;
    telescope += axis.chord * distance;
    loss[i + 1] = std::min(first_order + bend, telescope) * (1.0 + kRelativeSlack);
  }
}

PairBound::Range PairBound::range_of_least(std::size_t side, const Vector3d& n,
                                           const Pose& world_from_link,
                                           std::span<const Vector3d> points) const {
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& point : points) middle += point;
  middle /= static_cast<double>(points.size());
  double squared = 0.0;
  double along = std::numeric_limits<double>::infinity();
  const Vector3d center = world_from_link * middle;
  for (const Vector3d& point : points) {
    const Vector3d p = world_from_link * point;
    squared = std::max(squared, (p - center).squaredNorm());
    along = std::min(along, n.dot(p));
  }
  const double spread = std::sqrt(squared) * (1.0 + kRelativeSlack) + error_;
  Range range;
  losses(side, center, spread, n, range.lower);
  losses(side, center, -spread, n, range.upper);
  for (std::size_t i = 0; i <= axes_[side].size(); ++i) {
    range.lower[i] = along - range.lower[i];
    range.upper[i] = along - range.upper[i];
  }
  return range;
}

void PairBound::least(std::size_t side, const Vector3d& n, const Pose& world_from_link,
                      std::span<const Vector3d> points, Losses& result) const {
  const std::size_t count = axes_[side].size();
  std::fill_n(result.begin(), count + 1, std::numeric_limits<double>::infinity());
  Losses loss;
  // The point that is least at the middle comes first: a point that stands behind it by more than
  // it can lose itself, by any number of joints, is no least one.
  const std::size_t first = least_along(points, world_from_link.matrix().transpose() * n);
  const auto visit = [&](const Vector3d& point) {
    const Vector3d p = world_from_link * point;
    const double along = n.dot(p);
    if (along > result[0]) {
      double telescope = 0.0;
      for (const Axis& axis : axes_[side]) {
        telescope +=
            axis.turns ? axis.chord * ((p - axis.origin).norm() + 8.0 * error_) : axis.chord;
      }
      if (along - telescope * (1.0 + kRelativeSlack) > result[0]) return;
    }
    losses(side, p, 0.0, n, loss);
    for (std::size_t i = 0; i <= count; ++i) result[i] = std::min(result[i], along - loss[i]);
  };
  visit(points[first]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i != first) visit(points[i]);
  }
}

bool PairBound::are_apart(const Vector3d& n, const Pose& world_from_first,
                          std::span<const Vector3d> first, const Pose& world_from_second,
                          std::span<const Vector3d> second, double radii) const {
  const double needed = radii + slack();
  if (first.size() > 1 || second.size() > 1) {
    const Range of_first = range_of_least(0, n, world_from_first, first);
    const Range of_second = range_of_least(1, -n, world_from_second, second);
    if (any_above(needed, of_first.lower, of_second.lower)) return true;
    if (!any_above(needed, of_first.upper, of_second.upper)) return false;
  }
  Losses of_first;
  Losses of_second;
  least(0, n, world_from_first, first, of_first);
  least(1, -n, world_from_second, second, of_second);
  return any_above(needed, of_first, of_second);
}

bool PairBound::any_above(double least, const Losses& of_first, const Losses& of_second) const {
  const std::size_t count = joints_.size();
  for (std::size_t s = 0; s <= count; ++s) {
    if (of_first[s] + of_second[count - s] > least) return true;
  }
  return false;
}

double PairBound::motion(std::size_t step, const Vector3d& first, const Vector3d& second) const {
  const Axis& axis = axes_[0][step];
  if (!axis.turns) return axis.half;
  return axis.half * std::min(axis.direction.cross(first - axis.origin).norm(),
                              axis.direction.cross(second - axis.origin).norm());
}

}  // namespace spherule::internal
