// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Throws Error unless this thread rounds to nearest, as every proved bound presumes. What is built,
// loaded, fitted, certified, or memory of queries calls it once; single queries do not, and with
// another mode set after that no contact is missed in tests, but nothing is promised. Determined by
// sums, as std::fegetround() does not see every unit of a processor.
void require_rounding_to_nearest();

}  // namespace spherule
