// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/lane_check.h"

#include "collide/internal/plan_kernels.h"
#include "collide/robot/internal/plan_source.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

bool any_touches(const BodyPairs& pairs, std::span<const std::size_t> which,
                 const BodyPairs::Memory& memory) {
  return std::any_of(which.begin(), which.end(),
                     [&](std::size_t pair) { return pairs.touches(pair, memory); });
}

}  // namespace

LaneCheck::LaneCheck(const BodyPairs& pairs, InstructionSet instructions)
    : pairs_(pairs), positions_(pairs.robot()), kernels_(plan_kernels_for(instructions)) {
  RobotPlanSource all = make_plan_source(pairs, pairs.pairs().size());
  RobotPlanSource tested = make_plan_source(pairs, pairs.tested());
  single_ = std::make_shared<const CompiledPlan<float>>(all.source);
  exact_ = std::make_unique<const CompiledPlan<double>>(all.source);
  const bool is_all = pairs.tested() == pairs.pairs().size();
  configurations_ = is_all ? single_ : std::make_shared<const CompiledPlan<float>>(tested.source);
  one_ = std::make_unique<const CompiledWidePlan>(tested.source, *configurations_);
  single_error_ = static_cast<double>(single_->plan().velocity_error) / 16.0;
  pair_of_test_ = std::move(all.pair_of_test);
  BodyPairs::Memory memory;
  pairs.place(std::vector<double>(static_cast<std::size_t>(pairs.robot().variable_count())),
              memory);
  always_tested_ = any_touches(pairs, tested.fixed_pairs, memory);
  always_ = any_touches(pairs, all.fixed_pairs, memory);
}

template <class Real>
LaneCheck::Memory::Stage<Real>::Stage(const CompiledPlan<Real>& compiled)
    : plan(compiled),
      open(static_cast<std::size_t>(compiled.plan().word_count) * kPlanLanes),
      near(open.size()) {}

LaneCheck::Memory::Memory(const LaneCheck& check)
    : configurations_(*check.configurations_),
      one_(check.configurations_->plan(), *check.one_),
      single_(*check.single_),
      exact_(*check.exact_),
      room_(check.positions_.room_for(kLanes)) {
  const auto positions =
      static_cast<std::size_t>(std::max(1, check.single_->plan().position_count));
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
  BodyPairs::Memory& memory;
  int placed = -1;

  static bool touches(void* context, int lane, std::int32_t test) {
    auto& self = *static_cast<ConfigurationClient*>(context);
    if (std::exchange(self.placed, lane) != lane) {
      self.pairs.place(self.configurations[static_cast<std::size_t>(lane)], self.memory);
    }
    const auto source = static_cast<std::size_t>(self.plan.source_test(test));
    return self.pairs.touches(self.pair_of_test[source], self.memory);
  }
};

}  // namespace

unsigned LaneCheck::contacts(std::span<const std::span<const double>> configurations,
                             Memory& memory, BodyPairs::Memory& exact) const {
  const unsigned all = (1U << configurations.size()) - 1;
  if (always_tested_) return all;
  const CheckPlan<float>& plan = configurations_->plan();
  if (plan.test_count == 0) return 0;
  const PlanScratch<float>& scratch = memory.configurations_.view();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t i = std::min(lane, configurations.size() - 1);
    const std::span<const double> at = positions_.of(configurations[i], memory.room_, lane);
    for (std::size_t p = 0; p < at.size(); ++p) scratch.positions[p].lane[lane] = at[p];
  }
  ConfigurationClient client{pairs_, *configurations_, pair_of_test_, configurations, exact};
  return kernels_.single.check(plan, scratch, all,
                               {&ConfigurationClient::touches, nullptr, &client});
}

bool LaneCheck::touches(std::span<const double> configuration, Memory& memory,
                        BodyPairs::Memory& exact) const {
  if (always_tested_) return true;
  const CheckPlan<float>& plan = configurations_->plan();
  if (plan.test_count == 0) return false;
  const WideScratch& scratch = memory.one_.view();
  const std::span<const double> at = positions_.of(configuration, memory.room_);
  std::copy(at.begin(), at.end(), scratch.positions);
  ConfigurationClient client{pairs_, *configurations_, pair_of_test_, {&configuration, 1}, exact};
  return kernels_.check_one(plan, one_->plan(), scratch,
                            {&ConfigurationClient::touches, nullptr, &client});
}

}  // namespace spherule::internal
