// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/planning_cell.h"

#include <algorithm>
#include <cstdint>

namespace spherule {

bool collides(Checker& checker, const ArmPositions& positions) {
  std::uint8_t verdict = 0;
  checker.check({&positions, 1}, {&verdict, 1});
  return verdict != 0;
}

ContactTest contact_test(Checker& checker) {
  return [&checker](std::span<const double> configuration) {
    ArmPositions positions;
    std::copy_n(configuration.begin(), kJoints, positions.begin());
    return collides(checker, positions);
  };
}

}  // namespace spherule
