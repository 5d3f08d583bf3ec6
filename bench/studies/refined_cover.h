// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// More and smaller spheres over the same mesh: `count` of them (fewer if the mesh runs out of
// pieces, never less than the spheres of the cover that have a piece to hold). Every triangle of
// the mesh is cut into pieces, each inside a sphere of the cover; every new sphere encloses some of
// the pieces of one old sphere, and lies within this sphere grown by `slack`. So the new set covers
// the triangles, as the old one does, and is nowhere larger by more than `slack`: the same body
// with the same clearance. The inside of the body, where the old spheres fill it, is not covered.
//
// Both in exact arithmetic for the numbers as stored, but for the corners of the pieces, which are
// rounded, and for which radii are 1e-9 of themselves larger than they need be. Deterministic.
// Throws Error if the cover does not hold a piece of a triangle even after it was halved 40 times.
std::vector<Sphere> refine_cover(const TriangleMesh& mesh, std::span<const Sphere> cover,
                                 std::size_t count, double slack);

}  // namespace spherule
