// SPDX-License-Identifier: BSD-3-Clause
// For any machine; on x86 with SSE2, which all of its 64-bit processors have.
#include "collide/kernels/tree_kernel.h"

#include <cstddef>

#define SPHERULE_KERNEL portable
#include "collide/kernels/tree_block.h"

namespace spherule::internal {

const Kernels& portable_kernels() {
  return portable::kKernels;
}

}  // namespace spherule::internal
