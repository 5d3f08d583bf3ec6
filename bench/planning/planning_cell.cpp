// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/planning_cell.h"

#include <cstdint>

namespace spherule {

bool collides(Checker& checker, const ArmPositions& positions) {
  std::uint8_t verdict = 0;
  checker.check({&positions, 1}, {&verdict, 1});
  return verdict != 0;
}

}  // namespace spherule
