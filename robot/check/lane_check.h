// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/compiled_plan.h"
#include "collide/search/instruction_set.h"
#include "robot/check/body_pairs.h"
#include "robot/check/plan_source.h"
#include "robot/model/joint_positions.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace spherule::internal {

// Parts of a motion that wait, the one to be evaluated next on top, each with the tests that are
// open in it.
class PartStack {
 public:
  struct Part {
    double begin;
    double end;
  };

  bool empty() const { return parts_.empty(); }

  // `words` hold the set of tests of a part.
  void clear(std::size_t words) {
    words_ = words;
    parts_.clear();
    open_.clear();
  }

  // `open` is a set of tests.
  void push(const Part& part, const std::uint64_t* open) {
    parts_.push_back(part);
    open_.insert(open_.end(), open, open + words_);
  }
  void pop(Part& part, std::uint64_t* open) {
    part = parts_.back();
    parts_.pop_back();
    std::copy(open_.end() - static_cast<std::ptrdiff_t>(words_), open_.end(), open);
    open_.resize(open_.size() - words_);
  }

  // The earliest begin of those that wait; infinite if there is none.
  double earliest() const {
    double result = std::numeric_limits<double>::infinity();
    for (const Part& part : parts_) result = std::min(result, part.begin);
    return result;
  }

 private:
  std::size_t words_ = 0;
  std::vector<Part> parts_;
  std::vector<std::uint64_t> open_;
};

}  // namespace spherule::internal

// The fast check of all pairs of a RobotChecker: configurations and motions in lanes, in single
// precision, with the canonical tests of BodyPairs where that leaves something undecided.

namespace spherule::internal {

class LaneCheck {
 public:
  // `pairs`, of which the source is made, must outlive it. Throws Error for instructions that this
  // machine has not got, and for what reaches too far.
  LaneCheck(const BodyPairs& pairs, const RobotPlanSource& source, InstructionSet instructions);

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
  std::vector<std::size_t> pair_of_test_;  // of the source
  // Rigid pairs that are so near that the rounding of their poses decides.
  std::vector<std::size_t> rigid_pairs_;
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
