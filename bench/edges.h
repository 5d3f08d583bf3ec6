// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstddef>

namespace spherule {

// The moves from each configuration of a program to the next, as straight motions in joint space.
struct EdgeMeasurement {
  std::size_t free = 0;       // proved
  std::size_t collision = 0;  // a configuration in contact was found
  std::size_t unknown = 0;
  std::size_t unknown_but_free = 0;  // of these: no contact at 10,000 configurations on it
  double median_ns = 0.0;            // of single calls, the clock's own cost taken off
  double p95_ns = 0.0;
  double p99_ns = 0.0;
};

EdgeMeasurement measure_edges(const Workload& workload);

}  // namespace spherule
