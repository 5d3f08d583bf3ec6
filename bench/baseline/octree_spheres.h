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

#include "bench/baseline/made_conservative.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/level_tree.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <span>
#include <vector>

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

// Spheres in levels as the literature makes them, as a tree for queries.
//
// @code{.cpp}
//
// const spherule::SphereLevels spheres{
//     .levels = {{{{1, 0, 0}, 1.5}}, {{{0, 0, 0}, 1}, {{2, 0, 0}, 1}}}, .parents = {{0, 0}}};
// const auto made = spherule::enclosing_tree(spheres, spheres.levels.back());
// assert(made.tree.root().radius >= 2.0);  // made larger: it encloses its children
// @endcode

namespace spherule {

// Spheres in levels as the literature makes them, the coarsest first. Each level is meant to cover
// the solid by itself; a sphere need not enclose its children, only what they cover.
struct SphereLevels {
  std::vector<std::vector<Sphere>> levels;
  // parents[k][i]: the sphere of level k that sphere i of level k + 1 hangs under. One fewer than
  // levels.
  std::vector<std::vector<std::int32_t>> parents;
};

// Conservative if `leaves` are. A tree for the traversals of the library: its leaves are `leaves`,
// the finest level in its order, as it is or made conservative; the spheres above become as large
// as they have to be to enclose their children in exact arithmetic, about their own centre or,
// where that is smaller, about the centre of the sphere that encloses the children. A sphere
// without children is left out. Throws Error if the numbers of spheres and parents do not agree, or
// a parent is not there.
LevelTree enclosing_tree(const SphereLevels& levels, std::span<const Sphere> leaves);

}  // namespace spherule
