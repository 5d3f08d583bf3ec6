// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX-512 (F, DQ, BW, VL); compiled for these.
#include "collide/kernels/tree_kernel.h"

#include <cstddef>

#define SPHERULE_KERNEL avx512
#include "collide/kernels/tree_block.h"

namespace spherule::internal {

const Kernels& avx512_kernels() {
  return avx512::kKernels;
}

}  // namespace spherule::internal
