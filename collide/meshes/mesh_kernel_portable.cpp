// SPDX-License-Identifier: BSD-3-Clause
// For any machine; on x86 with SSE2, which all of its 64-bit processors have.
#include "collide/meshes/packed_mesh.h"

#include <cstddef>

#define SPHERULE_KERNEL mesh_portable
#include "collide/meshes/mesh_kernel_impl.h"

namespace spherule::internal {

MeshKernel portable_mesh_kernel() {
  return &mesh_portable::intersects;
}

}  // namespace spherule::internal
