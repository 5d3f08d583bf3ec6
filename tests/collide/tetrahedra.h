// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_contact.h"
#include "tests/collide/scene_random.h"

#include <memory>

namespace spherule::test {

// A closed tetrahedron, covered by one sphere a corner's cell and many more than it needs.
std::shared_ptr<const CoveredMesh> covered_tetrahedron(SceneRandom& random, double size);

// A mesh whose spheres are the spheres around its triangles.
std::shared_ptr<const CoveredMesh> covered_surface(const TriangleMesh& mesh);

// Its spheres, which keep it alive.
std::shared_ptr<const SphereTree> cover_of(const std::shared_ptr<const CoveredMesh>& mesh);

}  // namespace spherule::test
