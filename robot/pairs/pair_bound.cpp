// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/pair_bound.h"

#include "base/rounding.h"
#include "robot/pairs/free_boxes.h"
#include "robot/pairs/link_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

namespace spherule::internal {

using Eigen::Vector3d;

PairBound::PairBound(const RobotModel& robot, std::vector<int> joints, double error)
    : robot_(robot), joints_(std::move(joints)), error_(error) {
  const auto count = std::ssize(joints_);
  for (Axes& axes : axes_) {
    for (Axes::Row& row : axes.direction) row.resize(count);
    for (Axes::Row& row : axes.origin) row.resize(count);
    axes.half.resize(count);
    axes.chord.resize(count);
  }
}

void PairBound::place(std::span<const Pose> world_from_link, std::span<const double> half_widths) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = robot_.joints()[static_cast<std::size_t>(joints_[i])];
    const Pose& pose = world_from_link[static_cast<std::size_t>(joint.child_link)];
    const Vector3d direction = pose.matrix() * joint.axis;
    const double given = half_widths[static_cast<std::size_t>(joint.variable)] + FreeBoxes::kMargin;
    const double half = joint.mimics < 0 ? given : std::abs(joint.multiplier) * given;
    const double chord =
        joint.turns() ? 2.0 * std::sin(0.5 * std::min(half, std::numbers::pi)) : half;
    for (const std::size_t side : {0U, 1U}) {
      const std::size_t place = side == 0 ? i : joints_.size() - 1 - i;
      const auto row = static_cast<Eigen::Index>(place);
      Axes& axes = axes_[side];
      for (Eigen::Index c = 0; c < 3; ++c) {
        axes.direction[static_cast<std::size_t>(c)][row] = direction[c];
        axes.origin[static_cast<std::size_t>(c)][row] = pose.translation()[c];
      }
      axes.turns[place] = joint.turns();
      axes.half[row] = half;
      axes.chord[row] = chord;
    }
  }
}

void PairBound::losses(std::size_t side, const Vector3d& p, double spread, const Vector3d& n,
                       Losses& loss) const {
  const Axes& axes = axes_[side];
  const auto& [ax, ay, az] = axes.direction;
  const Axes::Row x = p.x() - axes.origin[0];
  const Axes::Row y = p.y() - axes.origin[1];
  const Axes::Row z = p.z() - axes.origin[2];
  const Axes::Row way_x = ay * z - az * y;
  const Axes::Row way_y = az * x - ax * z;
  const Axes::Row way_z = ax * y - ay * x;
  const Axes::Row distances =
      (way_x.square() + way_y.square() + way_z.square()).sqrt() + (spread + 8.0 * error_);
  const Axes::Row alongs = (n.x() * way_x + n.y() * way_y + n.z() * way_z).abs() + spread;
  double first_order = 0.0;
  double bend = 0.0;
  double paths = 0.0;  // sum of h r
  double telescope = 0.0;
  loss[0] = 0.0;
  for (Eigen::Index i = 0; i < axes.half.size(); ++i) {
    const double half = axes.half[i];
    double distance = 1.0;
    double reach = 1.0;
    double along = 0.0;
    if (axes.turns[static_cast<std::size_t>(i)]) {
      distance = distances[i];
      reach = distance + telescope;
      along = alongs[i];
      bend += half * (0.5 * half * reach + paths);
    } else {
      along = std::abs(n.x() * ax[i] + n.y() * ay[i] + n.z() * az[i]);
    }
    first_order += half * (along + 8.0 * error_);
    paths += half * reach;
    telescope += axes.chord[i] * distance;
    loss[static_cast<std::size_t>(i) + 1] =
        std::min(first_order + bend, telescope) * (1.0 + kRelativeSlack);
  }
}

void PairBound::least_of_ball(std::size_t side, const Vector3d& n, const Pose& world_from_link,
                              std::span<const Vector3d> points, Losses& result) const {
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
  losses(side, center, spread, n, result);
  for (std::size_t i = 0; i <= joints_.size(); ++i) result[i] = along - result[i];
}

void PairBound::least_of_point(std::size_t side, const Vector3d& n, const Vector3d& p,
                               Losses& result) const {
  const double along = n.dot(p);
  losses(side, p, 0.0, n, result);
  for (std::size_t i = 0; i <= joints_.size(); ++i) result[i] = along - result[i];
}

bool PairBound::may_lower(std::size_t side, const Vector3d& n, const Vector3d& p,
                          const Losses& least) const {
  const double along = n.dot(p);
  if (along < least[0]) return true;
  const Axes& axes = axes_[side];
  const Axes::Row lengths = ((p.x() - axes.origin[0]).square() + (p.y() - axes.origin[1]).square() +
                             (p.z() - axes.origin[2]).square())
                                .sqrt() +
                            8.0 * error_;
  double telescope = 0.0;
  for (Eigen::Index i = 0; i < axes.chord.size(); ++i) {
    telescope += axes.chord[i] * (axes.turns[static_cast<std::size_t>(i)] ? lengths[i] : 1.0);
    if (along - telescope * (1.0 + kRelativeSlack) < least[static_cast<std::size_t>(i) + 1]) {
      return true;
    }
  }
  return false;
}

void PairBound::lower_to_least(std::size_t side, const Vector3d& n, const Pose& world_from_link,
                               std::span<const Vector3d> points, Losses& result) const {
  Losses of_point;
  for (const Vector3d& point : points) {
    const Vector3d p = world_from_link * point;
    if (!may_lower(side, n, p, result)) continue;
    least_of_point(side, n, p, of_point);
    for (std::size_t i = 0; i <= joints_.size(); ++i) {
      result[i] = std::min(result[i], of_point[i]);
    }
  }
}

bool PairBound::are_apart(const Vector3d& n, const Pose& world_from_first,
                          std::span<const Vector3d> first, const Pose& world_from_second,
                          std::span<const Vector3d> second, double radii) const {
  const double needed = radii + slack();
  const Vector3d n_in_first = world_from_first.matrix().transpose() * n;
  const Vector3d n_in_second = world_from_second.matrix().transpose() * -n;
  Losses of_first;
  Losses of_second;
  least_of_point(0, n, world_from_first * first[least_along(first, n_in_first)], of_first);
  least_of_point(1, -n, world_from_second * second[least_along(second, n_in_second)], of_second);
  if (!any_above(needed, of_first, of_second)) return false;
  if (first.size() == 1 && second.size() == 1) return true;
  Losses of_ball;
  Losses of_other_ball;
  least_of_ball(0, n, world_from_first, first, of_ball);
  least_of_ball(1, -n, world_from_second, second, of_other_ball);
  if (any_above(needed, of_ball, of_other_ball)) return true;
  lower_to_least(0, n, world_from_first, first, of_first);
  if (!any_above(needed, of_first, of_second)) return false;
  lower_to_least(1, -n, world_from_second, second, of_second);
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
  const Axes& axes = axes_[0];
  const auto row = static_cast<Eigen::Index>(step);
  if (!axes.turns[step]) return axes.half[row];
  const auto& [ax, ay, az] = axes.direction;
  const Vector3d direction(ax[row], ay[row], az[row]);
  const Vector3d origin(axes.origin[0][row], axes.origin[1][row], axes.origin[2][row]);
  return axes.half[row] *
         std::min(direction.cross(first - origin).norm(), direction.cross(second - origin).norm());
}

namespace {

using Eigen::Vector3d;

// Pairs of leaves that one box leaves open before it is given up and halved, and of nodes that are
// handed down: beyond that the halves start from the roots.
constexpr std::size_t kMostOpenLeaves = 4;
constexpr std::size_t kLongestFront = 96;

bool pieces_apart(const PlacedPair& pair, const LinkPieces::Node& of_a,
                  const LinkPieces::Node& of_b, const Vector3d& start) {
  const auto points_of = [](const LinkPieces& pieces, const LinkPieces::Node& node) {
    return std::span(pieces.points)
        .subspan(static_cast<std::size_t>(node.first_point),
                 static_cast<std::size_t>(node.point_count));
  };
  const auto first = points_of(pair.of_first, of_a);
  const auto second = points_of(pair.of_second, of_b);
  const double radii = add_up(of_a.radius, of_b.radius);
  Vector3d direction = start.squaredNorm() > 0.0 ? start : Vector3d::UnitX();
  if (pair.direction_between(first, second, direction) <= radii) return false;
  return pair.bound.are_apart(direction, pair.world_from_first, first, pair.world_from_second,
                              second, radii);
}

}  // namespace

double PlacedPair::direction_between(std::span<const Vector3d> first,
                                     std::span<const Vector3d> second, Vector3d& direction) const {
  const Eigen::Matrix3d& rotation = world_from_first.matrix();
  const HullDirection found = hull_direction(
      first, second, rotation.transpose() * world_from_second.matrix(),
      rotation.transpose() * (world_from_second.translation() - world_from_first.translation()),
      rotation.transpose() * direction);
  direction = (rotation * found.direction).normalized();
  return found.gap;
}

bool clear_front(const PlacedPair& pair, std::vector<PieceNodes>& front, std::size_t& tests) {
  const LinkPieces& a = pair.of_first;
  const LinkPieces& b = pair.of_second;
  std::vector<PieceNodes> todo = std::move(front);
  front.clear();
  std::vector<PieceNodes> open_leaves;
  const auto way_between = [&pair](const Sphere& of_a, const Sphere& of_b) -> Vector3d {
    return pair.world_from_first * of_a.center - pair.world_from_second * of_b.center;
  };
  const auto gap = [&](const PieceNodes& nodes) {
    const Sphere& of_a = a.nodes[static_cast<std::size_t>(nodes.first)].sphere;
    const Sphere& of_b = b.nodes[static_cast<std::size_t>(nodes.second)].sphere;
    return way_between(of_a, of_b).norm() - of_a.radius - of_b.radius;
  };
  // What is nearest comes first: it is the likeliest to stay open, and then the rest need not be
  // examined.
  const auto add = [&](const PieceNodes& one, const PieceNodes& other) {
    const bool is_nearer = gap(one) < gap(other);
    todo.push_back(is_nearer ? other : one);
    todo.push_back(is_nearer ? one : other);
  };
  while (!todo.empty() && open_leaves.size() < kMostOpenLeaves) {
    ++tests;
    const PieceNodes nodes = todo.back();
    todo.pop_back();
    const auto& of_a = a.nodes[static_cast<std::size_t>(nodes.first)];
    const auto& of_b = b.nodes[static_cast<std::size_t>(nodes.second)];
    const Vector3d way = way_between(of_a.sphere, of_b.sphere);
    const double length = way.norm();
    const double radii = add_up(of_a.sphere.radius, of_b.sphere.radius);
    if (length > radii &&
        pair.bound.are_apart(way / length, pair.world_from_first, std::span(&of_a.sphere.center, 1),
                             pair.world_from_second, std::span(&of_b.sphere.center, 1), radii)) {
      continue;
    }
    if (of_a.point_count > 0 && of_b.point_count > 0 && pieces_apart(pair, of_a, of_b, way))
      continue;
    const bool is_leaf = of_a.first_child < 0;
    const bool other_is_leaf = of_b.first_child < 0;
    if (is_leaf && other_is_leaf) {
      open_leaves.push_back(nodes);
    } else if (other_is_leaf || (!is_leaf && of_a.sphere.radius > of_b.sphere.radius)) {
      add({of_a.first_child, nodes.second}, {of_a.first_child + 1, nodes.second});
    } else {
      add({nodes.first, of_b.first_child}, {nodes.first, of_b.first_child + 1});
    }
  }
  if (open_leaves.empty()) return true;
  front = std::move(todo);
  front.insert(front.end(), open_leaves.begin(), open_leaves.end());
  if (front.size() > kLongestFront) front = {{0, 0}};
  return false;
}

}  // namespace spherule::internal
