// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX2 and fused multiply-add; compiled for these.
#include "collide/kernels/check_plan.h"

#define SPHERULE_KERNEL avx2
#include "collide/kernels/plan_kernel_impl.h"

namespace spherule::internal {

const PlanKernelSet& avx2_plan_kernels() {
  return avx2::kPlanKernels;
}

}  // namespace spherule::internal
