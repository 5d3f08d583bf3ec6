// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism/mechanism_kernel.h"
#include "collide/mechanism/moved_sphere.h"
#include "spheretree/sphere.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

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
// Configurations that are far from the one before are searched as if there were no memory.
class CoherenceCache {
 public:
  // `reach` and `tilt` of the bodies as in mechanism_parts.h.
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
  MovedSphere contact_;
  double depth_ = -1.0;
  std::vector<std::int32_t> due_;  // bodies
  std::vector<KernelPair> pairs_;  // of those
  std::vector<char> is_due_;
};

}  // namespace spherule::internal
