// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX-512 (F, DQ, BW, VL); compiled for these.
#define SPHERULE_FLAT_KERNEL avx512
#include "bench/checkers/flat_scan/kernel_impl.h"

namespace spherule::flat_scan {

bool check_avx512(const Problem& problem, const double* configuration, const Scratch& scratch) {
  return avx512::check(problem, configuration, scratch);
}

}  // namespace spherule::flat_scan
