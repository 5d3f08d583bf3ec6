// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What only a few of eight configurations have to search, one configuration after the other. Part
// of the kernels, see plan_kernel_impl.h.

#include "collide/kernels/plan_wide.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// Lanes' configurations one by one.
class LaneSearch {
 public:
  LaneSearch(const CheckPlan<float>& plan, const PlanScratch<float>& scratch,
             const PlanClient& client)
      : plan_(plan), wide_(*scratch.wide), scratch_(scratch), client_(client) {}

  // Those of the lanes in which a test touches; of these one, if one is enough.
  unsigned touches(std::int32_t test, unsigned lanes, bool one_is_enough) const {
    unsigned contacts = 0;
    for (; lanes != 0 && (contacts == 0 || !one_is_enough); lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      WideSearch<LanePoses> search(plan_, wide_, *scratch_.wide_scratch, client_,
                                   LanePoses{scratch_.poses, lane}, lane);
      contacts |= (touches(test, search) ? 1U : 0U) << lane;
    }
    return contacts;
  }

 private:
  struct LanePoses {
    const PlanPose<float>* poses;
    int lane;
    float entry(std::int32_t frame, int column, int row) const {
      return poses[frame].columns[column][row][lane];
    }
  };

  bool touches(std::int32_t test, WideSearch<LanePoses>& search) const {
    if (test < plan_.first_pair) return search.touches_obstacle(test);
    const PlanPair& pair = plan_.pairs[test - plan_.first_pair];
    const WideBody& second = wide_.bodies[pair.second];
    return search.touches_pair(test, wide_.bodies[pair.first], second, search.root_of(second));
  }

  const CheckPlan<float>& plan_;
  const WidePlan& wide_;
  const PlanScratch<float>& scratch_;
  const PlanClient& client_;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
