// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/tree_kernel.h"
#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
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
// the root, W being how far the mechanism reaches (tree_check.cpp): v and w radius err by less
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

// What the last configurations of a mechanism have shown, for the next one. It changes no answer.
//
// Free. A body, grown by g, was apart from all that it is tested against. Wherever no point of it
// can have moved by more than g, it is apart ungrown, whatever the poses within the error that the
// spheres allow for. Bodies that are near to nothing need not even be tested for how far they have
// moved: the way of all their points since is at most the sum of |change| times the farthest that
// any point can be from the joint.
//
// So it is for all configurations between two: the sums and the ways of MovedSphere are bounded
// there by those of the ends.
//
// Touching. Two things were found to go into each other by more than a depth; wherever the one of
// them that moves has moved by less, they touch.
//
// Configurations that are far from the one before are searched as if there were no memory. So are
// those of a path in whose steps the memory has cost more than it saved, for a while, and for twice
// as long when it is tried again in vain. Motions (is_free_along()) are not counted and never
// pause.
class CoherenceCache {
 public:
  // `reach` and `tilt` of the bodies as TreeCheck has them.
  CoherenceCache(const KernelProblem& problem, std::span<const double> reach,
                 std::span<const double> tilt);

  // The answer of kernels.check().
  bool collides(const Kernels& kernels, const KernelProblem& problem, const double* configuration,
                const KernelScratch& scratch, ConfirmContact confirm, void* context);

  // Whether every body is apart from all that it is tested against on the whole straight motion of
  // the variables, from one configuration to another; `middle` is that between them, up to
  // rounding. False where that is not known soon; none where the motion does not follow the last
  // ones in small steps, as those of a path do.
  std::optional<bool> is_free_along(const Kernels& kernels, const KernelProblem& problem,
                                    const double* from, const double* to, const double* middle,
                                    const KernelScratch& scratch);

  // A sphere on a frame, in its coordinates, that touches for the last configuration that was
  // checked, and wherever none of its points has moved by more than `depth` from there. Ignored
  // unless is_following().
  void remember_contact(std::int32_t frame, const Sphere& sphere, double depth,
                        const KernelScratch& scratch);
  // Whether that is remembered: while collides() confirms, if the last configurations were near
  // each other.
  bool is_following() const { return is_following_ && is_confirming_; }

 private:
  struct Body {
    void forget() { clearance = free_until = placed_at = -1.0; }

    MovedSphere sphere;
    double clearance = -1.0;   // of the body where the sphere was placed; negative: none is known
    double free_until = -1.0;  // the length of the way up to which it is free without a test
    double placed_at = -1.0;   // the query for which it was placed; negative: it was not
    double step = 0.0;         // how far it moves from one query to the next
    double ambition = 0.0;     // the clearance to search for; 0 before the first
    float wanted = 0.0F;       // the same, in this query
  };

  bool check(const Kernels& kernels, const KernelProblem& problem, const double* configuration,
             const KernelScratch& scratch, ConfirmContact confirm, void* context);
  bool follow(const double* configuration);
  void forget();
  void account(double saved);
  bool find_due(const double* configuration);
  bool grow_due(const Kernels& kernels, const KernelProblem& problem, const double* configuration,
                const KernelScratch& scratch);
  bool grow_along(const Kernels& kernels, const KernelProblem& problem, std::int32_t index,
                  const double* from, const double* to, const double* middle,
                  const KernelScratch& scratch);
  static KernelFinding test(const Kernels& kernels, const KernelProblem& problem, std::int32_t body,
                            float inflation, const KernelScratch& scratch);
  void place(const KernelProblem& problem, std::int32_t index, const double* configuration,
             const KernelScratch& scratch, double clearance);

  std::vector<Body> bodies_;
  std::vector<double> reach_;  // of each variable: how far a point moves at most by its change
  double near_step_;
  std::vector<double> last_;
  double way_ = 0.0;
  double queries_ = 0.0;
  bool was_near_ = false;
  bool is_following_ = false;
  bool is_confirming_ = false;
  bool knows_ = false;
  double saved_ = 0.0;  // in searches of a configuration
  double pause_ = 0.0;  // for so many queries there is no memory
  double next_pause_;   // the length of the next one
  MovedSphere contact_;
  double depth_ = -1.0;
  std::vector<std::int32_t> due_;  // bodies
  std::vector<KernelPair> pairs_;  // of those
  std::vector<char> is_due_;
};

}  // namespace spherule::internal
