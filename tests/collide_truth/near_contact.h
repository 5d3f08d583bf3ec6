// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "tests/collide_truth/fitted_model.h"
#include "tests/support/random.h"

#include <cstddef>
#include <vector>

namespace spherule::test {

// Two placed models and what FCL says of them.
struct JudgedPose {
  Pose world_from_a, world_from_b;
  bool touching = false;
};

// At least `count` poses of a pair: random ones, and ones that were bisected along random
// directions until the models are within 2 mm, 0.1 mm and 1e-3 mm of the border between touching
// and free, with a pose on each side of the border. Every pose that the search has judged is
// returned. Lengths in millimetres.
std::vector<JudgedPose> judged_poses(const FittedModel& a, const FittedModel& b, std::size_t count,
                                     Random& random);

}  // namespace spherule::test
