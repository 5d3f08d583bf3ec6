// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/internal/lane_check.h"

#include "collide/kernels/plan_kernels.h"
#include "robot/check/internal/plan_source.h"
#include "robot/model/internal/moving_frames.h"

#include <algorithm>
#include <utility>

namespace spherule::internal {

LaneCheck::LaneCheck(const BodyPairs& pairs, InstructionSet instructions)
    : pairs_(pairs), positions_(pairs.robot()), kernels_(plan_kernels_for(instructions)) {
  RobotPlanSource all = make_plan_source(pairs, pairs.pairs().size());
  RobotPlanSource of_configurations = make_plan_source(pairs, pairs.static_tree_pairs_begin());
  motion_plan_float_ = std::make_shared<const CompiledPlan<float>>(all.source);
  motion_plan_double_ = std::make_unique<const CompiledPlan<double>>(all.source);
  const bool is_all = pairs.static_tree_pairs_begin() == pairs.pairs().size();
  config_plan_ = is_all ? motion_plan_float_
                        : std::make_shared<const CompiledPlan<float>>(of_configurations.source);
  wide_config_plan_ =
      std::make_unique<const CompiledWidePlan>(of_configurations.source, *config_plan_);
  pair_of_test_ = std::move(all.pair_of_test);
  decide_fixed_pairs(all.fixed_pairs);
  find_never_ranges();
}

void LaneCheck::find_never_ranges() {
  for (const CheckedPair& pair : pairs_.pairs()) {
    if (pair.boxes == nullptr || !pair.boxes->is_all_free()) continue;
    for (const FreeBoxes::Variable& variable : pair.boxes->variables()) {
      if (variable.wraps) continue;  // all positions are proved
      const auto index = static_cast<std::size_t>(variable.index);
      auto known = std::find_if(never_ranges_.begin(), never_ranges_.end(),
                                [&](const Range& range) { return range.variable == index; });
      if (known == never_ranges_.end()) {
        known = never_ranges_.insert(known, {index, variable.lower, variable.upper});
      }
      known->lower = std::max(known->lower, variable.lower);
      known->upper = std::min(known->upper, variable.upper);
    }
  }
}

// Ranges are intervals: on a straight motion it is enough to test both ends.
bool LaneCheck::never_touch(std::span<const double> configuration) const {
  return std::all_of(never_ranges_.begin(), never_ranges_.end(), [&](const Range& range) {
    const double value = configuration[range.variable];
    return range.lower <= value && value <= range.upper;
  });
}

// Pairs that no joint moves: of static ones the canonical poses are always the same. Those that
// move together are apart in all configurations if they are in one by far more than rounding; the
// others are tested one by one.
void LaneCheck::decide_fixed_pairs(std::span<const std::size_t> pairs) {
  // Of both bodies, in both configurations, with the slack of the canonical test: 4.
  constexpr double kFar = 8.0;
  BodyPairs::Scratch scratch;
  pairs_.place(std::vector<double>(static_cast<std::size_t>(pairs_.robot().variable_count())),
               scratch);
  const MovingFrames frames(pairs_.robot());
  for (const std::size_t pair : pairs) {
    const CheckedPiece& piece =
        pairs_.pieces()[static_cast<std::size_t>(pairs_.pairs()[pair].piece)];
    const bool is_static = frames.frame_of_link[static_cast<std::size_t>(piece.link)] < 0;
    if (is_static && pairs_.touches(pair, scratch)) {
      motions_have_static_contact_ = true;
      configs_have_static_contact_ |= pair < pairs_.static_tree_pairs_begin();
    }
    if (!is_static && pairs_.is_near(pair, kFar * pairs_.pose_error(), scratch)) {
      rigid_pairs_.push_back(pair);
    }
  }
}

template <class Real>
LaneCheck::Scratch::Stage<Real>::Stage(const CompiledPlan<Real>& compiled, const WidePlan* wide,
                                       const WideScratch* wide_scratch)
    : plan(compiled, wide, wide_scratch),
      open(static_cast<std::size_t>(compiled.plan().word_count) * kPlanLanes),
      near(open.size()) {}

LaneCheck::Scratch::Scratch(const LaneCheck& check)
    : wide_config_plan_(check.config_plan_->plan(), *check.wide_config_plan_),
      config_plan_(*check.config_plan_, &check.wide_config_plan_->plan(),
                   &wide_config_plan_.view()),
      motion_plan_float_(*check.motion_plan_float_,
                         check.motion_plan_float_ == check.config_plan_
                             ? &check.wide_config_plan_->plan()
                             : nullptr,
                         &wide_config_plan_.view()),
      motion_plan_double_(*check.motion_plan_double_, nullptr, nullptr),
      positions_(check.positions_.scratch_for(kLanes)),
      proofs_(check.pairs_) {
  const auto positions =
      static_cast<std::size_t>(std::max(1, check.motion_plan_float_->plan().position_count));
  from_.resize(positions);
  to_.resize(positions);
  variables_.resize(static_cast<std::size_t>(check.pairs_.robot().variable_count()));
}

namespace {

// The configurations of the lanes, for the canonical tests.
struct ConfigurationClient {
  const BodyPairs& pairs;
  const CompiledPlan<float>& plan;
  std::span<const std::size_t> pair_of_test;
  std::span<const std::span<const double>> configurations;
  BodyPairs::Scratch& scratch;
  int placed = -1;

  static bool touches(void* context, int lane, std::int32_t test) {
    auto& self = *static_cast<ConfigurationClient*>(context);
    if (std::exchange(self.placed, lane) != lane) {
      self.pairs.place(self.configurations[static_cast<std::size_t>(lane)], self.scratch);
    }
    return self.pairs.touches(self.pair_of(test), self.scratch);
  }
  static bool is_proved_free(void* context, int lane, std::int32_t test) {
    const auto& self = *static_cast<ConfigurationClient*>(context);
    return self.pairs.pairs()[self.pair_of(test)].boxes->contains(
        self.configurations[static_cast<std::size_t>(lane)]);
  }

  std::size_t pair_of(std::int32_t test) const {
    return pair_of_test[static_cast<std::size_t>(plan.source_test(test))];
  }
  // For one evaluation.
  PlanClient client(bool skips_never) {
    return {.touches = &touches,
            .near = nullptr,
            .is_proved_free = &is_proved_free,
            .is_motion_proved = nullptr,
            .proved_parts = nullptr,
            .context = this,
            .skips_never = skips_never};
  }
};

}  // namespace

bool LaneCheck::rigid_pairs_touch(std::span<const double> configuration,
                                  BodyPairs::Scratch& canonical) const {
  if (rigid_pairs_.empty()) return false;
  pairs_.place(configuration, canonical);
  return std::any_of(rigid_pairs_.begin(), rigid_pairs_.end(),
                     [&](std::size_t pair) { return pairs_.touches(pair, canonical); });
}

unsigned LaneCheck::contacts(std::span<const std::span<const double>> configurations,
                             Scratch& scratch, BodyPairs::Scratch& canonical) const {
  const unsigned all = (1U << configurations.size()) - 1;
  if (configs_have_static_contact_) return all;
  unsigned rigid = 0;
  for (std::size_t i = 0; i < configurations.size() && !rigid_pairs_.empty(); ++i) {
    rigid |= (rigid_pairs_touch(configurations[i], canonical) ? 1U : 0U) << i;
  }
  const CheckPlan<float>& plan = config_plan_->plan();
  if (plan.test_count == 0) return rigid;
  const PlanScratch<float>& lanes = scratch.config_plan_.view();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t i = std::min(lane, configurations.size() - 1);
    const std::span<const double> at = positions_.of(configurations[i], scratch.positions_, lane);
    for (std::size_t p = 0; p < at.size(); ++p) lanes.positions[p].lane[lane] = at[p];
  }
  ConfigurationClient client{pairs_, *config_plan_, pair_of_test_, configurations, canonical};
  const bool skips_never = std::all_of(
      configurations.begin(), configurations.end(),
      [&](std::span<const double> configuration) { return never_touch(configuration); });
  return rigid | kernels_.check_lanes(plan, lanes, all & ~rigid, client.client(skips_never));
}

bool LaneCheck::touches(std::span<const double> configuration, Scratch& scratch,
                        BodyPairs::Scratch& canonical) const {
  if (configs_have_static_contact_ || rigid_pairs_touch(configuration, canonical)) return true;
  const CheckPlan<float>& plan = config_plan_->plan();
  if (plan.test_count == 0) return false;
  const WideScratch& wide = scratch.wide_config_plan_.view();
  const std::span<const double> at = positions_.of(configuration, scratch.positions_);
  std::copy(at.begin(), at.end(), wide.positions);
  ConfigurationClient client{pairs_, *config_plan_, pair_of_test_, {&configuration, 1}, canonical};
  return kernels_.check_one(plan, wide_config_plan_->plan(), wide,
                            client.client(never_touch(configuration)));
}

}  // namespace spherule::internal
