// SPDX-License-Identifier: BSD-3-Clause
// For any processor.
#include "collide/kernels/check_plan.h"

#define SPHERULE_KERNEL portable
#include "collide/kernels/plan_kernel_impl.h"

namespace spherule::internal {

const PlanKernelSet& portable_plan_kernels() {
  return portable::kPlanKernels;
}

}  // namespace spherule::internal
