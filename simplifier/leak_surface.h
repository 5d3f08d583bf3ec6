// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The part of a mesh that sticks out of spheres, as a surface to be coloured by its depth.
//
// @code{.cpp}
// #include <spherule/simplifier/leak_surface.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const std::vector<spherule::Sphere> spheres{{{0.25, 0.25, 0.25}, 0.5}};
// const spherule::LeakSurface leaks = spherule::leak_surface(tetrahedron, spheres);
// assert(!leaks.mesh.triangles.empty() && leaks.depths.size() == leaks.mesh.vertices.size());
// @endcode

#include "mesh/triangle_mesh.h"
#include "spheretree/sphere.h"

#include <span>
#include <vector>

namespace spherule {

// Pieces of a surface, and how far each of their vertices is outside of all spheres.
struct LeakSurface {
  TriangleMesh mesh;           // oriented as the surface it is a part of
  std::vector<double> depths;  // one a vertex, 0 on the border of the part
};

// How closely the border of a leak is followed.
struct LeakSurfaceOptions {
  // The size of the smallest pieces that a triangle is divided into, as a share of the diagonal of
  // the mesh's box; positive.
  double spacing = 1.0 / 80.0;
};

// The part of the surface that is outside of all spheres, for showing where to look. Vertices are
// on the surface, up to its rounding, with their distances to the nearest sphere. In between, the
// distance is interpolated, and so is the border of the part, and what is covered or leaks in spots
// of some spacings may go unseen: certify() proves. Without any sphere there is no depth to tell,
// and the surface is empty. Equal input gives equal output. Throws Error as leak_points().
LeakSurface leak_surface(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                         const LeakSurfaceOptions& options = {});

}  // namespace spherule
