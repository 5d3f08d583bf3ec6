// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"

#include "base/error.h"

namespace spherule {

// To nearest, a quarter of the distance to the next number above 1 is rounded off, and three
// quarters are rounded up to it. Upwards, the first is not; downwards and towards zero, the second.
void require_rounding_to_nearest() {
  volatile double one = 1.0;
  volatile double quarter = 0x1p-54;
  volatile double three_quarters = 0x1.8p-53;
  const double first = one + quarter;
  const double second = one + three_quarters;
  if (first != 1.0 || second != 1.0 + 0x1p-52) {
    throw Error("rounding mode", "must be to nearest: no bound is proved for another one");
  }
}

}  // namespace spherule
