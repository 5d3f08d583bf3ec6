// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Which instructions queries may use. Answers are equal for all of them (G7).
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

// Whether this machine has it; kAvx2 requires fused multiply-add, too, and kAvx512 for the
// extensions F, DQ, BW and VL.
bool is_available(InstructionSet set);

// The fastest that this machine has.
InstructionSet best_instruction_set();

}  // namespace spherule
