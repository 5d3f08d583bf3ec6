// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/configuration.h"
#include "bench/workload.h"

namespace spherule {

// True if `checker` finds a collision.
bool collides(Checker& checker, const ArmPositions& positions);

// The same for the configurations of any robot. Keeps referring to it.
ContactTest contact_test(Checker& checker);

}  // namespace spherule
