// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How far two links can come towards each other anywhere in a box of joint positions (for G9).
//
// Setting. Joints 1 to k lie on the path from the first link to the second; x0 is the middle of the
// box and joint j is anywhere within h_j of it. Look from the link behind joint s, any s from 0 to
// k: joints 1 to s move the first link, joint s outermost, and joints s + 1 to k the second one,
// joint s + 1 outermost. With p a point of the first link, as placed at the middle; z_j, o_j the
// axis of joint j at the middle; d_j = |z_j x (p - o_j)|, or 1 for a shift; c_j = 2 sin(min(h_j,
// pi) / 2), or h_j for a shift:
//
// Telescope. p moves by at most sum over j <= s of c_j d_j. Proof: change joint s first, the others
// at the middle: a chord of c_s d_s at most. Then joint s - 1, and so on: what joint j moves in its
// own frame is p as at the middle, because the joints inside of it are still there, so by at most
// c_j d_j; and the joints outside of it, wherever they are, are rigid motions, which keep lengths.
//
// First order. Along a unit vector n of the observer, p moves by at most
//     sum of h_j |n . w_j|  +  sum of h_j r_j (h_j t_j / 2 + sum over i from j + 1 to s of h_i
//     t_i),
// w_j = z_j x (p - o_j) or z_j, t_j = 1 where joint j turns, else 0, r_j = d_j + sum over i < j of
// c_i d_i, or 1 for a shift. Proof: on the straight line from x0 the velocity at x0 is the sum of
// dx_j w_j, and half of the greatest acceleration bounds what is left. That is at most the sum of
// collide/kernels/plan_vectors.h, with r_j at least the distance of p from axis j anywhere in the
// box: the joints inside of j move p by at most their telescope, in the frame that carries axis j.
//
// The smaller of the two is the loss of p for this s. The same holds for the second link from the
// other side.
//
// Points together. Of points within q of a place c, d_j is at most that of c + q, and |n . w_j| at
// most that of c + q where joint j turns: with these no point's loss is more than the one for c
// and q. That decides for most pieces that are apart; the point that comes nearest at the middle
// decides for most that are not; for the rest each point counts by itself.
//
// Hulls. n is fixed in the observer's frame. A point of a convex hull is the same mixture of its
// corners in every configuration, so the least of n . p over the hull is that of a corner, and
//     min over corners a of (n . a - loss(a)) - max over corners b of (n . b + loss(b)) - radii
// bounds the gap of two hulls of points with radii in the whole box, for each s by itself; one s
// for which it is positive proves that they have no point in common anywhere in the box.
//
// A box of variables. Joints that follow one variable count each by itself, with |multiplier| times
// its half-width: a larger set than the one needed. Half-widths are taken larger by
// FreeBoxes::kMargin, which all that FreeBoxes says of configurations near a box needs.
//
// Rounding. Let e be kinematics_error_bound() for the larger reach of the two links. The computed
// images of points at the middle are within e of those of the exact mechanism, 40 u (|p| + |t|) for
// the image included: 40 u of reach and length beside the (60 n + 10) u reach + (60 n + 85) u L of
// e, whose budget uses 54 n + 8 and 54 n + 79 of these, so that 2 e covers both. So d_j and n . w_j
// err by less than 4 (2 e) (the argument of link_paths.cpp), which are added to each; q, a distance
// of two images, by less than 8 u (reach + L) < e, which is added to it. The sums that
// follow are of positive terms, with at most 3 k^2 + 40 roundings, k <= 16: less than
// kRelativeSlack of them, which is added, and which covers sines, mimics' factors (4 u), and
// |n| = 1 +- 4 u in the products with losses.
// n . a - n . b: two images 4 e; products and sums 6 u (|a| + |b|) with |a|, |b| <= reach + L,
// which is below e; |n| turns a gap g into g (1 +- 4 u), of the same sign. Then the gap has to
// survive under computed poses as well, of any configuration: 2 e more. 7 e in all; kSlackOfError.

#include "base/rounding.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/link_pieces.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

using Eigen::Vector3d;

inline constexpr double kSlackOfError = 8.0;
inline constexpr double kRelativeSlack = 1e-9;

class PairBound {
 public:
  static constexpr std::size_t kMostJoints = 16;

  // The joints that move between the two, from the first link on, at most kMostJoints; `error` is
  // the e above.
  PairBound(const RobotModel& robot, std::vector<int> joints, double error)
      : robot_(robot), joints_(std::move(joints)), error_(error) {
    const auto count = std::ssize(joints_);
    for (Axes& axes : axes_) {
      for (Axes::Row& row : axes.direction) row.resize(count);
      for (Axes::Row& row : axes.origin) row.resize(count);
      axes.half.resize(count);
      axes.chord.resize(count);
    }
  }

  // At the middle of a box: poses of all links, and half-widths of the robot's variables.
  void place(std::span<const Pose> world_from_link, std::span<const double> half_widths) {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const Joint& joint = robot_.joints()[static_cast<std::size_t>(joints_[i])];
      const Pose& pose = world_from_link[static_cast<std::size_t>(joint.child_link)];
      const Vector3d direction = pose.matrix() * joint.axis;
      const double given =
          half_widths[static_cast<std::size_t>(joint.variable)] + FreeBoxes::kMargin;
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

  // Whether two hulls, in the frames of the two links, are proved apart in the whole box, by the
  // direction `n`, in the world at the middle, from the second to the first.
  bool are_apart(const Vector3d& n, const Pose& world_from_first, std::span<const Vector3d> first,
                 const Pose& world_from_second, std::span<const Vector3d> second,
                 double radii) const {
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

  // How much joint `step` (of the path) moves a point at most: to first order, of the smaller side.
  double motion(std::size_t step, const Vector3d& first, const Vector3d& second) const {
    const Axes& axes = axes_[0];
    const auto row = static_cast<Eigen::Index>(step);
    if (!axes.turns[step]) return axes.half[row];
    const auto& [ax, ay, az] = axes.direction;
    const Vector3d direction(ax[row], ay[row], az[row]);
    const Vector3d origin(axes.origin[0][row], axes.origin[1][row], axes.origin[2][row]);
    return axes.half[row] * std::min(direction.cross(first - origin).norm(),
                                     direction.cross(second - origin).norm());
  }

  std::span<const int> joints() const { return joints_; }
  double slack() const { return kSlackOfError * error_; }

 private:
  // Of the joints that move a side, the nearest to the link first: an array a coordinate, so that
  // points are moved about all of them at once.
  struct Axes {
    using Row = Eigen::Array<double, Eigen::Dynamic, 1, 0, static_cast<int>(kMostJoints), 1>;
    std::array<Row, 3> direction;
    std::array<Row, 3> origin;
    std::array<bool, kMostJoints> turns{};
    Row half;   // h
    Row chord;  // c
  };
  using Losses = std::array<double, kMostJoints + 1>;

  // When so many joints move them, no point of the first (0) or second (1) link that is within
  // `spread` of p loses more.
  void losses(std::size_t side, const Vector3d& p, double spread, const Vector3d& n,
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

  // For each number of joints that move it, n . p - loss of a point of a side, and a lower bound of
  // it for points, by a sphere around them.
  void least_of_point(std::size_t side, const Vector3d& n, const Vector3d& p,
                      Losses& result) const {
    const double along = n.dot(p);
    losses(side, p, 0.0, n, result);
    for (std::size_t i = 0; i <= joints_.size(); ++i) result[i] = along - result[i];
  }
  void least_of_ball(std::size_t side, const Vector3d& n, const Pose& world_from_link,
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

  // False only if p has no part in the least of points of which others have reached `least`: by the
  // telescope, which is cheaper than losses().
  bool may_lower(std::size_t side, const Vector3d& n, const Vector3d& p,
                 const Losses& least) const {
    const double along = n.dot(p);
    if (along < least[0]) return true;
    const Axes& axes = axes_[side];
    const Axes::Row lengths =
        ((p.x() - axes.origin[0]).square() + (p.y() - axes.origin[1]).square() +
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

  // Lowers `result`, of some of the points, to the least over all.
  void lower_to_least(std::size_t side, const Vector3d& n, const Pose& world_from_link,
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

  // Whether the two together are above `least` for any distribution of the joints.
  bool any_above(double least, const Losses& of_first, const Losses& of_second) const {
    const std::size_t count = joints_.size();
    for (std::size_t s = 0; s <= count; ++s) {
      if (of_first[s] + of_second[count - s] > least) return true;
    }
    return false;
  }

  const RobotModel& robot_;
  std::vector<int> joints_;
  double error_;
  std::array<Axes, 2> axes_;
};

// A node of the tree of pieces of each of two links.
struct PieceNodes {
  std::int32_t first;
  std::int32_t second;
};

// Two links at the middle of a box, and the bound for all of it. Refers to what it is given.
struct PlacedPair {
  const LinkPieces& of_first;
  const Pose& world_from_first;
  const LinkPieces& of_second;
  const Pose& world_from_second;
  const PairBound& bound;

  // Between two sets of points, each in the frame of its link: the direction in the world, searched
  // from the one given, and the gap along it, up to rounding.
  double direction_between(std::span<const Vector3d> first, std::span<const Vector3d> second,
                           Vector3d& direction) const {
    const Eigen::Matrix3d& rotation = world_from_first.matrix();
    const HullDirection found = hull_direction(
        first, second, rotation.transpose() * world_from_second.matrix(),
        rotation.transpose() * (world_from_second.translation() - world_from_first.translation()),
        rotation.transpose() * direction);
    direction = (rotation * found.direction).normalized();
    return found.gap;
  }
};

// Pairs of leaves that one box leaves open before it is given up and halved, and of nodes that are
// handed down: beyond that the halves start from the roots.
inline constexpr std::size_t kMostOpenLeaves = 4;
inline constexpr std::size_t kLongestFront = 96;

inline bool pieces_apart(const PlacedPair& pair, const LinkPieces::Node& of_a,
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

// Takes from a front, pairs of nodes that hold all pairs of leaves not proved apart yet, what is
// proved apart throughout the box, and opens the rest. True if nothing is left. Adds to `tests` how
// many pairs of nodes it examined.
inline bool clear_front(const PlacedPair& pair, std::vector<PieceNodes>& front,
                        std::size_t& tests) {
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
