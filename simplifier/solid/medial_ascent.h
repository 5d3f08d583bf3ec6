// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"

#include <vector>

namespace spherule::internal {

struct AscentStep {
  Eigen::Vector3d point;
  double clearance;  // lower bound
};

struct AscentOptions {
  // Length of the first step; later ones double as long as they succeed.
  double first_step = 0.0;
  // Steps shorter than this are not tried.
  double least_step = 0.0;
};

// Moves a point of S away from its contact, as the paper moves an internal sphere "away from the
// collision along the normal", until it touches in two or more places that stop it: a step must
// raise the clearance by 0.6 of its length, so that touching a second external sphere beside the
// first, which hardly stops it, does not count. Moving by t against one
// contact raises the clearance by t, so the grown sphere contains the former one. Returns the
// positions taken, from the start to the end, which is on or near the medial axis of S.
std::vector<AscentStep> ascend(const Clearance& clearance, const Eigen::Vector3d& start,
                               const AscentOptions& options);

}  // namespace spherule::internal
