// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX2 and fused multiply-add; compiled for these.
#define SPHERULE_FLAT_KERNEL avx2
#include "bench/checkers/flat_scan/kernel_impl.h"

namespace spherule::flat_scan {

bool check_avx2(const Problem& problem, const double* configuration, const Scratch& scratch) {
  return avx2::check(problem, configuration, scratch);
}

}  // namespace spherule::flat_scan
