// SPDX-License-Identifier: BSD-3-Clause
#include "collide/instruction_set.h"

namespace spherule {

bool is_available(InstructionSet set) {
#if defined(SPHERULE_AVX2_KERNEL)
  if (set == InstructionSet::kAvx2) {
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  }
#endif
  return set == InstructionSet::kPortable;
}

InstructionSet best_instruction_set() {
  return is_available(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kPortable;
}

}  // namespace spherule
