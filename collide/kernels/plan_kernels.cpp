// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/plan_kernels.h"

#include "spheretree/error.h"

namespace spherule::internal {

const PlanKernelSet& plan_kernels_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("instruction set", "this machine has not got it");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx512) return avx512_plan_kernels();
  if (instructions == InstructionSet::kAvx2) return avx2_plan_kernels();
#endif
  return portable_plan_kernels();
}

}  // namespace spherule::internal
