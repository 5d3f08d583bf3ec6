// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace spherule {

// Of this process so far, in ticks of a microsecond: what is timed by it runs on one thread, and
// what else the machine does hardly shows.
inline double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace spherule
