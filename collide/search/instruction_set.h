// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Instruction sets that queries may use.
//
// @code{.cpp}
// #include <spherule/collide/search/instruction_set.h>
// #include <cassert>
//
// assert(spherule::is_available(spherule::InstructionSet::kPortable));
// assert(spherule::is_available(spherule::best_instruction_set()));
// @endcode

namespace spherule {

// Which instructions queries may use. Answers are equal for all of them (G7).
enum class InstructionSet { kPortable, kAvx2, kAvx512 };

// Whether this machine has it; kAvx2 requires fused multiply-add, too, and kAvx512 for the
// extensions F, DQ, BW and VL.
bool is_available(InstructionSet set);

// The fastest that this machine has.
InstructionSet best_instruction_set();

}  // namespace spherule
