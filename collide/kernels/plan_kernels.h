// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/check_plan.h"
#include "collide/search/instruction_set.h"

namespace spherule::internal {

// Throws Error for instructions that this machine has not got.
const PlanKernelSet& plan_kernels_for(InstructionSet instructions);

}  // namespace spherule::internal
