// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Configurations against sphere trees that stand still, in single precision: a fast test before an
// exact one, for one configuration and for blocks of them, with a cache for those of a path.

#include "collide/kernels/check_plan_source.h"
#include "collide/kernels/coherence_cache.h"
#include "collide/kernels/tree_kernel.h"
#include "collide/search/instruction_set.h"
#include "collide/search/packed_tree.h"
#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// Two spheres of which single precision cannot tell whether they touch: of a test of the source, by
// their indices among the spheres of its body and of its obstacle.
struct TreeContact {
  std::int32_t test = 0;
  std::int32_t body_sphere = 0;
  std::int32_t obstacle_sphere = 0;
};

// Tests of bodies that joints move against obstacles that are trees. For each configuration it
// finds either that no two spheres of a test touch, or that some do, for sure; where rounding
// leaves that uncertain it calls `confirm`. If a side of any test is_confirmed, no contact counts
// as sure.
//
// Proof in tree_check.cpp. Exactness is meant with respect to any poses of the bodies that are
// within PlanSource::pose_error of those of the exact mechanism. Bodies on one frame, and
// obstacles, that are tested against the same are searched as one tree. Threads may share it, each
// with a scratch of its own.
class TreeCheck {
 public:
  // Of the tests of the source from `first_test` on. Throws Error for a mechanism or an obstacle
  // that reaches beyond kMaxCoordinate (joined with those that it is searched with, too), and for
  // instructions that this machine has not got.
  TreeCheck(const PlanSource& source, std::size_t first_test,
            InstructionSet instructions = best_instruction_set());
  TreeCheck(const TreeCheck&) = delete;
  TreeCheck& operator=(const TreeCheck&) = delete;

  // What a query writes to.
  class Scratch {
   public:
    explicit Scratch(const TreeCheck& check);
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

   private:
    friend class TreeCheck;
    std::vector<double> middle_;  // of a motion
    std::vector<double> sines_;
    std::vector<double> cosines_;
    std::vector<KernelPose> poses_;
    std::vector<KernelTask> roots_;
    std::vector<KernelTask> tasks_;
    std::vector<KernelLaneVariable> lane_variables_;
    std::vector<KernelLanePose> lane_poses_;
    std::vector<KernelQueue> queues_;
    std::vector<KernelSpheres> placed_;
    std::vector<std::uint64_t> generations_;
    std::uint64_t generation_ = 0;
    std::vector<KernelMemory> memories_;
    KernelScratch view_ = {};
    CoherenceCache cache_;
  };

  // Whether all positions are finite and none is larger than kLargestPosition in magnitude.
  static bool is_in_range(std::span<const double> positions);

  // True if two spheres of a test touch for sure or `confirm`, given a TreeContact, says so of two
  // that may; false if none do. is_in_range() must hold, for as many positions as the frames name.
  // The scratch remembers contacts and clearances from one configuration to the next, which changes
  // no answer: near the last ones it may answer without calling `confirm`. Allocates nothing.
  template <class Confirm>
  bool collides(std::span<const double> positions, Scratch& scratch, Confirm confirm) const {
    const ConfirmFunction confirm_function = [](void* context, int,
                                                const TreeContact& contact) -> bool {
      return (*static_cast<Confirm*>(context))(contact);
    };
    return collides(positions, scratch, confirm_function, std::addressof(confirm));
  }

  // Whether no two spheres of a test touch for any positions on the straight motion from one
  // configuration to another, in exact arithmetic: true only if so, false where that is not known
  // soon. None where the motion does not follow in small steps the configuration or motion that was
  // checked last with the scratch, as those of a path do. is_in_range() must hold for both ends.
  // Allocates nothing.
  std::optional<bool> is_free_along(std::span<const double> from, std::span<const double> to,
                                    Scratch& scratch) const;

  // For `confirm` of collides() to say that a sphere (in the coordinates of the test's body)
  // touches an obstacle, and would wherever none of its points has moved by more than `depth` from
  // where the exact mechanism has it. That is remembered, where it is worth while, for
  // configurations near this one; it changes no answer.
  void remember_contact(std::int32_t test, const Sphere& sphere, double depth,
                        Scratch& scratch) const;
  // Whether it is worth while: the last configurations were near each other.
  bool is_following(const Scratch& scratch) const { return scratch.cache_.is_following(); }

  // Configurations that are checked side by side; answers are bits, the first configuration's is
  // the lowest.
  static constexpr std::size_t kBlock = kLanes;

  // Which configurations of a block collide, and for which is_in_range() does not hold; `confirm`,
  // as collides() of one configuration calls it, is given the configuration's index, too. Each
  // pointer leads to as many positions as the frames name. Fast where neighbours in the block
  // differ little; the scratch remembers contacts from block to block, which changes no answer.
  // Allocates nothing.
  template <class Confirm>
  KernelBlockAnswer collides(std::span<const double* const, kBlock> configurations,
                             Scratch& scratch, Confirm confirm) const {
    const ConfirmFunction confirm_function = [](void* context, int index,
                                                const TreeContact& contact) -> bool {
      return (*static_cast<Confirm*>(context))(index, contact);
    };
    return collides(configurations, scratch, confirm_function, std::addressof(confirm));
  }

 private:
  using ConfirmFunction = bool (*)(void* context, int index, const TreeContact& contact);
  bool collides(std::span<const double> positions, Scratch& scratch,
                ConfirmFunction confirm_function, void* context) const;
  KernelBlockAnswer collides(std::span<const double* const, kBlock> configurations,
                             Scratch& scratch, ConfirmFunction confirm_function,
                             void* context) const;

  // Where a sphere of a joined set comes from.
  struct Origin {
    int part = 0;  // a body or an obstacle of the source
    std::int32_t sphere = 0;
  };
  // Bodies on one frame, in that frame, or obstacles, in the root's, that are searched as one.
  struct Joined {
    int frame = -1;
    std::vector<Sphere> spheres{};
    std::vector<Origin> origins{};
  };
  struct Scene;
  struct Translator;

  void compile_trees(const Scene& scene, const PlanSource& source,
                     std::span<const PlanSource::Test> tests);

  // Of the source: the frame of each body and where it is in it; the test of each body and
  // obstacle.
  std::vector<std::pair<int, Pose>> body_places_;
  std::size_t obstacle_count_ = 0;
  std::vector<std::int32_t> tests_;
  std::vector<int> body_of_test_;
  // Of the joined bodies and obstacles.
  std::vector<std::vector<Origin>> body_origins_;
  std::vector<std::vector<Origin>> obstacle_origins_;
  // The kernel's problem, with what it points to.
  std::vector<KernelFrame> frames_;
  std::vector<KernelLaneFrame> lane_frames_;
  std::vector<PackedTree> trees_;
  std::vector<KernelBody> bodies_;
  std::vector<KernelObstacle> obstacles_;
  std::vector<KernelPair> pairs_;
  KernelProblem problem_{};
  // Of the joined bodies: no point is further from the root; a bound of their frames' errors in
  // direction, and, times the reach, in position.
  std::vector<double> reach_;
  std::vector<double> tilt_;
  const Kernels* kernels_;
  std::int64_t task_count_ = 1;
};

}  // namespace spherule::internal
