// SPDX-License-Identifier: BSD-3-Clause
// For any machine; the compiler's vectors of 16 bytes.
#define SPHERULE_FLAT_KERNEL portable
#include "bench/checkers/flat_scan/kernel_impl.h"

namespace spherule::flat_scan {

bool check_portable(const Problem& problem, const double* configuration, const Scratch& scratch) {
  return portable::check(problem, configuration, scratch);
}

}  // namespace spherule::flat_scan
