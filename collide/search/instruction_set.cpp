// SPDX-License-Identifier: BSD-3-Clause
#include "collide/search/instruction_set.h"

#include <initializer_list>

namespace spherule {

bool is_available(InstructionSet set) {
#if defined(SPHERULE_X86_KERNELS)
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (set == InstructionSet::kAvx2) return has_avx2;
  if (set == InstructionSet::kAvx512) {
    return has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  }
#endif
  return set == InstructionSet::kPortable;
}

InstructionSet best_instruction_set() {
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2}) {
    if (is_available(set)) return set;
  }
  return InstructionSet::kPortable;
}

}  // namespace spherule
