// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/compiled_plan.h"

#include <algorithm>

namespace spherule::internal {

template <class Real>
PlanMemory<Real>::PlanMemory(const CompiledPlan<Real>& compiled, const WidePlan* wide,
                             const WideScratch* wide_scratch) {
  const CheckPlan<Real>& plan = compiled.plan();
  const auto positions = static_cast<std::size_t>(std::max(1, plan.position_count));
  positions_.resize(positions);
  poses_.resize(static_cast<std::size_t>(plan.frame_count));
  twists_.resize(poses_.size());
  centers_.resize(compiled.center_count());
  placed_.resize(centers_.size());
  candidates_.resize(static_cast<std::size_t>(plan.test_count));
  tasks_.resize(compiled.task_count());
  from_.resize(positions);
  to_.resize(positions);
  rates_.resize(positions);
  speeds_.resize(positions + 1);
  shifts_.resize(positions + 1);
  body_bounds_.resize(static_cast<std::size_t>(plan.body_count));
  pair_bounds_.resize(static_cast<std::size_t>(plan.pair_count));
  has_bounds_ = std::make_unique<bool[]>(static_cast<std::size_t>(plan.bound_count));
  path_work_.resize(2 * compiled.longest_path() + 4);
  view_ = {positions_.data(),   poses_.data(),
           twists_.data(),      centers_.data(),
           placed_.data(),      &evaluation_,
           candidates_.data(),  tasks_.data(),
           from_.data(),        to_.data(),
           rates_.data(),       speeds_.data(),
           shifts_.data(),      body_bounds_.data(),
           pair_bounds_.data(), path_work_.data(),
           &total_speed_,       &recent_,
           has_bounds_.get(),   wide,
           wide_scratch};
}

template class PlanMemory<float>;
template class PlanMemory<double>;

}  // namespace spherule::internal
