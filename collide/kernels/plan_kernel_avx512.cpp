// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX-512 (F, DQ, BW, VL); compiled for these.
#include "collide/kernels/check_plan.h"

#define SPHERULE_KERNEL avx512
#include "collide/kernels/plan_kernel_impl.h"

namespace spherule::internal {

const PlanKernelSet& avx512_plan_kernels() {
  return avx512::kPlanKernels;
}

}  // namespace spherule::internal
