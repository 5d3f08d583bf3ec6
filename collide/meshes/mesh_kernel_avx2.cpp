// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX2 and fused multiply-add; compiled for these.
#include "collide/meshes/packed_mesh.h"

#include <cstddef>

#define SPHERULE_KERNEL mesh_avx2
#include "collide/meshes/mesh_kernel_impl.h"

namespace spherule::internal {

MeshKernel avx2_mesh_kernel() {
  return &mesh_avx2::intersects;
}

}  // namespace spherule::internal
