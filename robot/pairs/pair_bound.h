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
// err by less than 4 (2 e) (the argument of path_reach.cpp), which are added to each; q, a distance
// of two images, by less than 8 u (reach + L) < e, which is added to it. The sums that
// follow are of positive terms, with at most 3 k^2 + 40 roundings, k <= 16: less than
// kRelativeSlack of them, which is added, and which covers sines, mimics' factors (4 u), and
// |n| = 1 +- 4 u in the products with losses.
// n . a - n . b: two images 4 e; products and sums 6 u (|a| + |b|) with |a|, |b| <= reach + L,
// which is below e; |n| turns a gap g into g (1 +- 4 u), of the same sign. Then the gap has to
// survive under computed poses as well, of any configuration: 2 e more. 7 e in all; kSlackOfError.

#include "robot/model/robot_model.h"
#include "robot/pairs/link_pieces.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

inline constexpr double kSlackOfError = 8.0;
inline constexpr double kRelativeSlack = 1e-9;

class PairBound {
 public:
  static constexpr std::size_t kMostJoints = 16;

  // The joints that move between the two, from the first link on, at most kMostJoints; `error` is
  // the e above.
  PairBound(const RobotModel& robot, std::vector<int> joints, double error);

  // At the middle of a box: poses of all links, and half-widths of the robot's variables.
  void place(std::span<const Pose> world_from_link, std::span<const double> half_widths);

  // Whether two hulls, in the frames of the two links, are proved apart in the whole box, by the
  // direction `n`, in the world at the middle, from the second to the first.
  bool are_apart(const Eigen::Vector3d& n, const Pose& world_from_first,
                 std::span<const Eigen::Vector3d> first, const Pose& world_from_second,
                 std::span<const Eigen::Vector3d> second, double radii) const;

  // How much joint `step` (of the path) moves a point at most: to first order, of the smaller side.
  double motion(std::size_t step, const Eigen::Vector3d& first,
                const Eigen::Vector3d& second) const;
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
  void losses(std::size_t side, const Eigen::Vector3d& p, double spread, const Eigen::Vector3d& n,
              Losses& loss) const;
  // For each number of joints that move it, n . p - loss of a point of a side, and a lower bound of
  // it for points, by a sphere around them.
  void least_of_point(std::size_t side, const Eigen::Vector3d& n, const Eigen::Vector3d& p,
                      Losses& result) const;
  void least_of_ball(std::size_t side, const Eigen::Vector3d& n, const Pose& world_from_link,
                     std::span<const Eigen::Vector3d> points, Losses& result) const;
  // False only if p has no part in the least of points of which others have reached `least`: by the
  // telescope, which is cheaper than losses().
  bool may_lower(std::size_t side, const Eigen::Vector3d& n, const Eigen::Vector3d& p,
                 const Losses& least) const;
  // Lowers `result`, of some of the points, to the least over all.
  void lower_to_least(std::size_t side, const Eigen::Vector3d& n, const Pose& world_from_link,
                      std::span<const Eigen::Vector3d> points, Losses& result) const;
  // Whether the two together are above `least` for any distribution of the joints.
  bool any_above(double least, const Losses& of_first, const Losses& of_second) const;

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
  double direction_between(std::span<const Eigen::Vector3d> first,
                           std::span<const Eigen::Vector3d> second,
                           Eigen::Vector3d& direction) const;
};

// Takes from a front, pairs of nodes that hold all pairs of leaves not proved apart yet, what is
// proved apart throughout the box, and opens the rest. True if nothing is left. Adds to `tests` how
// many pairs of nodes it examined.
bool clear_front(const PlacedPair& pair, std::vector<PieceNodes>& front, std::size_t& tests);

}  // namespace spherule::internal
