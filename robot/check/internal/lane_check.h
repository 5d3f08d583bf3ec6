// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The fast check of all pairs of a RobotChecker: configurations and motions in lanes, in single
// precision, with the canonical tests of BodyPairs where that leaves something undecided.

#include "collide/instruction_set.h"
#include "collide/kernels/compiled_plan.h"
#include "collide/kernels/compiled_wide_plan.h"
#include "robot/check/internal/body_pairs.h"
#include "robot/check/internal/edge_proofs.h"
#include "robot/check/internal/part_stack.h"
#include "robot/model/joint_positions.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace spherule::internal {

class LaneCheck {
 public:
  // `pairs` must outlive it. Throws Error for instructions that this machine has not got, and for
  // what reaches too far.
  LaneCheck(const BodyPairs& pairs, InstructionSet instructions);

  // What a query writes to.
  class Scratch {
   public:
    explicit Scratch(const LaneCheck& check);

   private:
    friend class LaneCheck;
    // Of motions, evaluated in Real.
    template <class Real>
    struct Stage {
      Stage(const CompiledPlan<Real>& plan, const WidePlan* wide, const WideScratch* wide_scratch);
      PlanMemory<Real> plan;
      PartStack waiting;
      std::vector<std::uint64_t> open;
      std::vector<std::uint64_t> near;
    };
    WideMemory wide_config_plan_;
    PlanMemory<float> config_plan_;
    Stage<float> motion_plan_float_;
    Stage<double> motion_plan_double_;
    JointPositions::Scratch positions_;
    std::vector<double> from_;  // positions
    std::vector<double> to_;
    std::vector<double> variables_;
    EdgeProofs proofs_;
    std::vector<std::uint64_t> undecided_;
  };

  // Configurations that are checked side by side.
  static constexpr std::size_t kLanes = kPlanLanes;

  // `canonical`, below, is what the canonical tests of BodyPairs write to.

  // A bit for each of up to kLanes configurations in which any of the pairs of BodyPairs before
  // static_tree_pairs_begin() touches, by the canonical tests. Each must be in_filter_range().
  unsigned contacts(std::span<const std::span<const double>> configurations, Scratch& scratch,
                    BodyPairs::Scratch& canonical) const;

  // The same of one configuration.
  bool touches(std::span<const double> configuration, Scratch& scratch,
               BodyPairs::Scratch& canonical) const;

  // The straight motion up to the fraction `end`, all pairs of BodyPairs, as RobotChecker says of
  // check_edge(). Both ends must be in_filter_range(), the resolution above zero.
  EdgeResult check_edge(std::span<const double> from, std::span<const double> to, double end,
                        const EdgeRequest& request, Scratch& scratch,
                        BodyPairs::Scratch& canonical) const;

 private:
  class Edge;

  // Of the pairs that never touch: the ranges of variables in which all of them are proved.
  struct Range {
    std::size_t variable = 0;
    double lower = 0.0;
    double upper = 0.0;
  };
  void find_never_ranges();
  bool never_touch(std::span<const double> configuration) const;
  void decide_fixed_pairs(std::span<const std::size_t> pairs);
  bool rigid_pairs_touch(std::span<const double> configuration,
                         BodyPairs::Scratch& canonical) const;

  const BodyPairs& pairs_;
  JointPositions positions_;
  const PlanKernelSet& kernels_;
  // Rigid pairs that are so near that the rounding of their poses decides.
  std::vector<std::size_t> rigid_pairs_;
  std::vector<std::size_t> pair_of_test_;  // of the source
  std::vector<Range> never_ranges_;
  // Of the pairs before static_tree_pairs_begin(): configurations in lanes, and one alone.
  std::shared_ptr<const CompiledPlan<float>> config_plan_;
  std::unique_ptr<const CompiledWidePlan> wide_config_plan_;
  // Of all pairs. What single precision leaves undecided is evaluated in double precision.
  std::shared_ptr<const CompiledPlan<float>> motion_plan_float_;
  std::unique_ptr<const CompiledPlan<double>> motion_plan_double_;
  // Whether a pair touches of which both sides stand still: any; one that configurations test here.
  bool motions_have_static_contact_ = false;
  bool configs_have_static_contact_ = false;
};

}  // namespace spherule::internal
