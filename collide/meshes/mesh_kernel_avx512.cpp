// SPDX-License-Identifier: BSD-3-Clause
// For x86 processors with AVX-512 (F, DQ, BW, VL); compiled for these.
#include "collide/meshes/packed_mesh.h"

#include <cstddef>

#define SPHERULE_KERNEL mesh_avx512
#include "collide/meshes/mesh_kernel_impl.h"

namespace spherule::internal {

MeshKernel avx512_mesh_kernel() {
  return &mesh_avx512::intersects;
}

}  // namespace spherule::internal
