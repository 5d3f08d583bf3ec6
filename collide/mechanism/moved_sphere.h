// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism/mechanism_kernel.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// A sphere on a frame where one configuration of a mechanism has it, and how far any of its points
// can be from there in another.
//
// Along the straight motion q(t) = q + t D of the variables let p be a point of the sphere, and for
// the joint of each frame k on the way from the root a_k the axis and o_k the origin, all moving.
// The velocity of p is the sum of D_k a_k x (p - o_k) for turns and D_k a_k for shifts. With c the
// centre it is v + w x (p - c), v and w being the sums for c and of D_k a_k over turns, so at the
// start it is at most |v| + |w| radius. Its derivative is a sum over all pairs of joints: with i
// before or equal to k
//     D_i D_k a_i x (a_k x (p - o_k)),  D_i D_k a_i x a_k for a shift k,  0 for a shift i,
// twice for i < k. So p has moved by at most
//     |v| + |w| radius + sum over turns i of |D_i| (|D_i| L_i / 2 + sum over k > i of |D_k| L_k),
// where L_k = 1 for shifts and otherwise bounds |p - o_k| on the way.
// That is at most what it is at the start, plus what joints beyond k move p by seen from frame k,
// sum |D_j| L_j. Where all these together stay below `room`, L_k = |c - o_k| + radius + room is
// such a bound: it holds at the start, and as long as it holds p cannot come to where it fails.
// Beyond that nothing is known.
//
// For all configurations between two, D is between those of the ends: |v| + |w| radius, which is
// convex in D, is at most the larger of the ends, and so is every |D_k|.
//
// Rounding. As placed, origins and centres err by 2.1e-11 n W and axes by 2.1e-11 n, n frames from
// the root, W being how far the mechanism reaches (mechanism_parts.cpp): v and w radius err by less
// than 1e-10 (n + 1) (W + radius) sum |D_k| together. The caller gives twice that per sum |D_k|.
// All other roundings are far below kRelative.
class MovedSphere {
 public:
  // Nothing is known of it at first; allocates for frames at most.
  MovedSphere(const KernelFrame* frames, std::size_t count, double error);

  // In the frame, as placed for the configuration.
  void place(std::int32_t frame, const double* center, double radius, const KernelPose* poses,
             const double* configuration);

  // An upper bound, infinite if none is known.
  double way_to(const double* configuration) const;
  // For every configuration between two.
  double way_along(const double* from, const double* to) const;

 private:
  template <std::size_t kEnds>
  double way(const double* const (&ends)[kEnds]) const;

  static constexpr double kRelative = 1e-6;
  static constexpr double kRoom = 0.25;  // of the largest |c - o_k| + radius

  struct Joint {
    double at;  // the variable
    double center_rate[3];
    double turn_rate[3];
    double reach;  // L_k
    std::int32_t variable;
    bool prismatic;
  };

  const KernelFrame* frames_;
  double error_;
  std::vector<Joint> joints_;  // from the sphere's frame to the root
  std::size_t count_ = 0;
  double radius_ = 0.0;
  double room_ = 0.0;
};

}  // namespace spherule::internal
