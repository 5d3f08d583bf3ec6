// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres by adaptive medial axis approximation: not conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/medial_axis.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto made = spherule::medial_axis(
//     tetrahedron,
//     {.spheres = 8, .sampling = {.cover_points = 500, .initial_sites = 100, .max_sites = 200}});
// assert(!made.spheres.empty() && made.spheres.size() <= 8 && made.protrusion > 0.0);
// @endcode

#include "bench/baseline/octree_spheres.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule {

// How many medial spheres become few (internal/sphere_reduction.h says how each works).
enum class SphereReduction {
  kMerge,   // two neighbours become one
  kBurst,   // one goes, its neighbours grow
  kExpand,  // all grow by the same, few are chosen
  kBest     // each of the three, and the best result is kept (default)
};

// How the surface is sampled.
struct MedialSampling {
  // Points of the surface that have to be covered: spread evenly, at least some on every triangle,
  // and, beside them, all corners and points of the edges as densely.
  std::size_t cover_points = 10000;
  std::size_t cover_points_per_triangle = 2;
  // Sites of the Voronoi diagram: at first, and at most after refinement.
  std::size_t initial_sites = 1000;
  std::size_t max_sites = 6000;
  // The medial spheres are refined towards a protrusion of the wanted one divided by this. Above 0,
  // at most 1e6.
  double error_factor = 2.0;
  std::uint64_t seed = 1;
};

// What is wanted: a number of spheres, or a protrusion.
struct MedialAxisOptions {
  // Wanted number of spheres; not examined if there is a wanted protrusion.
  std::size_t spheres = 512;
  // Wanted protrusion from the solid, in the unit of the mesh; 0: the count is what is wanted.
  double max_protrusion = 0.0;
  SphereReduction reduction = SphereReduction::kBest;
  MedialSampling sampling = {};
  int threads = 0;  // 0: all
};

// The spheres, and what they were chosen from.
struct MedialAxisSpheres {
  std::vector<Sphere> spheres;
  // Upper bound, up to rounding, of the largest distance from a point of the spheres to the solid:
  // the centres' clearances are measured. For open meshes inside is what MeshProbe takes for it.
  double protrusion = 0.0;
  std::size_t medial_spheres = 0;  // that they were made from
  std::size_t sites = 0;           // of the Voronoi diagram
  std::size_t cover_points = 0;    // all of them are in the spheres, in exact arithmetic
};

// Not conservative: the spheres hold all points that were sampled on the surface, and nothing is
// promised between them, nor of the inside of the solid; made_conservative() grows them until they
// cover. Adaptive medial-axis approximation (AMAA) after Bradshaw and O'Sullivan, "Adaptive
// medial-axis approximation for sphere-tree construction" (ACM Transactions on Graphics 23, 2004):
// spheres about the vertices of the Voronoi diagram of points on the surface that lie in the solid;
// more points where they protrude most; few spheres made of them by merging, bursting and
// expanding. With a wanted count there are at most so many spheres (fewer if the points need
// fewer); with a wanted protrusion they protrude by at most that, or by what the finest medial
// spheres do where `max_sites` did not suffice, and they are as few as the reductions find. Where
// they depart from the paper is said at each (internal/medial_spheres.h,
// internal/sphere_reduction.h). Where there is no inside (sheets), spheres about points of the
// surface are merged. Deterministic for equal input on any number of threads. Throws Error for a
// mesh that validate() refuses or that has no area, and for options out of range.
MedialAxisSpheres medial_axis(const TriangleMesh& mesh, const MedialAxisOptions& options = {});

// The shape of the tree.
struct MedialTreeOptions {
  int branching = 8;  // 2 to 64
  int depth = 3;      // levels below the root: at most branching^depth leaves. 1 to 8
  SphereReduction reduction = SphereReduction::kBest;
  MedialSampling sampling = {};
  int threads = 0;  // 0: all
};

// Not conservative: every level holds all points that were sampled on the surface, see
// medial_axis(); a sphere need not enclose its children (enclosing_tree() makes a tree of them that
// does). Level 0 is one sphere; the points of a sphere are covered anew by at most `branching`
// spheres of the next level, made of the medial spheres nearby, which are refined before each level
// until they protrude by less than that level by error_factor. Departure from the paper: they are
// refined over the whole solid at once, not sphere by sphere. Errors as there.
SphereLevels medial_axis_tree(const TriangleMesh& mesh, const MedialTreeOptions& options = {});

}  // namespace spherule
