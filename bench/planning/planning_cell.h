// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

namespace spherule {

// True if `checker` finds a collision.
bool collides(Checker& checker, const ArmPositions& positions);

}  // namespace spherule
