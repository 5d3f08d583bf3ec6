// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX2 and fused multiply-add; compiled for these.
#include "collide/kernels/tree_kernel.h"

#include <cstddef>

#define SPHERULE_KERNEL avx2
#include "collide/kernels/tree_block.h"

namespace spherule::internal {

const Kernels& avx2_kernels() {
  return avx2::kKernels;
}

}  // namespace spherule::internal
