// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/solid_mesh.h"
#include "spheretree/sphere.h"

#include <vector>

namespace spherule::internal {

// Spheres that together hold all of a solid, in its frame: a sphere around each triangle, grown as
// the solid is, and spheres around the cells of an octree that hold the inside. They stand out
// where triangles do, and at the surface by a cell, of which there are about as many as triangles:
// for a search that rules out what is not near the solid.
//
// Proof. What is within inflation() of a triangle is in its sphere. A point of the inside lies in
// the root cell, which contains inside().box(). A cell whose sphere intersects no triangle lies,
// whole, on one side: it is left out only if its centre is outside. One whose sphere may intersect
// a triangle is left out if a triangle's sphere holds all of it (those of the tree's nodes hold the
// spheres below them, so that the search for it loses none); else it is split, until it is small or
// there are too many, and then its sphere is kept.
std::vector<Sphere> spheres_around(const SolidMesh& solid);

}  // namespace spherule::internal
