// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere trees by halving cubes: conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/octree_spheres.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::OctreeSpheres made = spherule::octree_spheres(tetrahedron, {.depth = 3});
// assert(made.tree.depth() == 3 && made.step < 0.2);
// @endcode

#include "bench/baseline/filling.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

namespace spherule {

// How far cubes are halved.
struct OctreeSpheresOptions {
  // Halvings of the cube around the mesh; or 0, and max_error says how far to go.
  int depth = 0;
  // E: cubes are halved until their sphere is known to protrude from |M| by at most E, in the unit
  // of the mesh. In pockets that are filled, see below, it may be more.
  double max_error = 0.0;
  Filling filling = Filling::kSolid;
  // t: cubes that M grown by this much intersects count as the surface's; vertex_error is added.
  double padding = 0.0;
};

// The spheres, as a tree.
struct OctreeSpheres {
  // spheres() of this tree are the spheres around the cubes without halves; the inner nodes are the
  // spheres around the others, and nothing else.
  SphereTree tree;
  double step = 0.0;  // edge of the smallest cubes
};

// Conservative (with Filling::kSurface: of the surface M only). The sphere tree of Liu, Noborio and
// Arimoto (1988) and of Palmer and Grimsdale, "Collision Detection for Animation using
// Sphere-Trees" (1995): an octree over the mesh, with the sphere around every cube that is not
// empty. A cube that M intersects (as in voxelise()) is halved down to the given depth; a cube
// inside as long as its sphere may protrude by more than those of the smallest cubes. With
// max_error instead of a depth a cube that M intersects is halved only while the bound on its
// sphere's protrusion, radius plus (minus, if the centre is inside) the distance of the centre to
// M, is above E.
//
// The tree serves the same traversal as any other. The sphere around a cube contains those around
// its halves, touching them at the corners, so that no other parents are needed than the method's
// own; radii are larger by a share of 1e-12 or so, that they do so in rounded numbers, too.
//
// Pockets of the outside whose way in is hardly wider than the smallest cubes are filled.
// Throws Error for a mesh that validate() refuses, for options out of range (a depth of at most
// 20), and for a depth or error that makes more than 2^24 cells, with the numbers.
OctreeSpheres octree_spheres(const TriangleMesh& mesh, const OctreeSpheresOptions& options);

}  // namespace spherule
