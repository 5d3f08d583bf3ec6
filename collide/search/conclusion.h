// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"

#include <algorithm>

namespace spherule::internal {

// What a search that has ended, `result.complete` or not, says about two bodies. The query has
// found() and smallest_gap(), the pose its gap_error().
template <class Query, class AnyPose>
void conclude(const Query& query, const AnyPose& pose, CollisionResult& result) {
  std::sort(result.pairs.begin(), result.pairs.end());
  if (query.found()) {
    result.verdict = Verdict::kCollision;
  } else if (result.complete) {
    result.verdict = Verdict::kFree;
    result.distance_lower_bound =
        std::max(0.0, query.smallest_gap() * kRelativeDown - pose.gap_error());
  }
}

}  // namespace spherule::internal
