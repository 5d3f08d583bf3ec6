// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "tests/support/random.h"

#include <string>

// COLLADA and glTF files with what a scene graph may hold, written without any code of the library.

namespace spherule::test {

// The mesh as geometry #g under a skin with the joint J, which stands at 7 along z; it is bound 50
// along x.
std::string skinned_dae(const TriangleMesh& mesh);

// One mesh with a skin without inverse bind matrices, in a node at (7, 7, 7); its joint stands at
// 100 along x.
std::string skinned_gltf(const TriangleMesh& mesh);

// One mesh with a morph target that moves it by 50 along x, with the weight 1.
std::string morphed_gltf(const TriangleMesh& mesh);

// The mesh in some nodes under each other, with random transforms of every kind; in COLLADA also
// in instances of nodes, as polygons or as strips of one triangle.
std::string random_dae(const TriangleMesh& mesh, Random& random);
std::string random_gltf(const TriangleMesh& mesh, Random& random);

}  // namespace spherule::test
