// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/packed_mesh.h"
#include "collide/search/instruction_set.h"

namespace spherule::internal {

MeshKernel mesh_kernel_for(InstructionSet set);
// Of this machine.
MeshKernel best_mesh_kernel();

// within() with the kernel of an instruction set, which this machine must have; collides() for a
// clearance of 0.
bool collides_by(MeshKernel kernel, const SphereTree& a, const Pose& world_from_a,
                 const MeshTree& b, const Pose& world_from_b, double clearance = 0.0) noexcept;

}  // namespace spherule::internal
