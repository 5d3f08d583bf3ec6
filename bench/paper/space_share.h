// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/simplify.h"

namespace spherule {

// The share of the box that no external sphere covers (the paper's figure 3), by the centres of
// cells of which `along` lie along the box's longest edge. Errs by the cells that a sphere's
// surface passes.
double uncovered_share(const ExternalSpheres& external, int along);

}  // namespace spherule
