// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Methods of comparison that make meshes of a mesh, whether each is conservative, and how far what
// they make is from it.

namespace spherule {

// How closely a deviation is measured.
struct DeviationOptions {
  // How far apart lower and upper bound may be at the end, as a share of the box diagonal of both
  // meshes; from 1e-6 to 1.
  double tolerance = 1e-3;
  // Pieces of surface to examine in either direction before the bounds are left farther apart.
  std::size_t most_pieces = 100'000;
};

// How far a mesh that stands for another one, the original, is from it. The solid of a closed mesh
// (MeshReport::closed) is its surface and every point with a winding number other than zero; that
// of an open one is its surface alone. Lengths in the unit of the meshes.
struct MeshDeviation {
  // One-sided Hausdorff distance from the surface of the original to the solid of the other. Where
  // it is zero nothing of the surface is lost; else what touches the original may pass the other at
  // up to this distance: a missed collision.
  Bounds loss;
  // One-sided Hausdorff distance from the surface of the other to the solid of the original: how
  // far the other sticks out, so from how far it may report a collision that is none.
  Bounds excess;
};

// Measures both. Distances to a solid change by no more than one moves, so the surface is cut into
// triangles until no piece can hold a point farther than the farthest found by more than the
// tolerance (Guthe, Borodin and Klein 2005 do the same over surfaces). The bounds are of the exact
// distances up to rounding of some 1e-14 of the extent: a measurement, no proof. Several parts that
// overlap may be given as one mesh, if each is closed and faces outwards. Throws Error for a mesh
// that validate() refuses and for options out of range.
MeshDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& other,
                                const DeviationOptions& options = {});

// Decimation by quadric error: not conservative. It cuts off what stands out and fills what is
// hollow, both unbounded by its estimate of the error; measure_deviation() tells by how much.

// How far a mesh is reduced.
struct DecimationOptions {
  // How many triangles are wanted; the result has more where no collapse of an edge is allowed or
  // the error would pass max_error.
  std::size_t target_triangles = 1;
  // Largest estimated error, in the unit of the mesh; infinite: no limit.
  double max_error = std::numeric_limits<double>::infinity();
  // How the deviation is measured; nothing: not at all.
  std::optional<DeviationOptions> measure = DeviationOptions{};
};

// The reduced mesh, and how far it is from the original.
struct Decimation {
  TriangleMesh mesh;  // its vertices are vertices of the original, bit for bit
  // meshoptimizer's estimate: root of the mean square distance to the planes that met in a vertex.
  // No bound, and often far below the deviation.
  double estimated_error = 0.0;
  MeshDeviation deviation;  // measured; zero if not requested
};

// Decimates by edge collapses in order of their quadric error (Garland and Heckbert 1997), by
// meshoptimizer. A closed mesh stays closed in the sense of MeshReport (a collapse joins vertices,
// which takes no boundary in), but edges used by more than two triangles may appear. meshoptimizer
// works in 32-bit floats, relative to the box: equal input gives equal results. Triangles that fall
// together are left out. Throws Error for a mesh that validate() refuses, a target of zero, a
// max_error that is negative or NaN, an extent of zero, and if nothing of the mesh is left.
Decimation decimate(const TriangleMesh& mesh, const DecimationOptions& options);

// Convex hull: conservative (proved, with outward rounding).

// Points whose extent across some plane is at most this share of their extent are flat: their hull
// has no inside that rounding leaves intact.
inline constexpr double kFlatShare = 1e-9;

// What the hull is to hold beside the mesh.
struct ConvexHullOptions {
  // Every sphere of this radius about a vertex of the mesh is inside too (the mesh's vertex_error
  // is added). It moves flat and long hulls more at their far ends than across; for larger
  // distances grow the mesh itself.
  double padding = 0.0;
  // How far a vertex may be moved, as a share of the extent of the vertices (and ten paddings), for
  // the proof to succeed: triangles that are long and thin require more than others.
  double max_expansion = 1e-6;
};

// The hull, and how far it is from convex.
struct ConvexHull {
  // Closed, each edge used once in either direction, facing outwards; convex up to `expansion`: no
  // vertex is farther than that beyond the plane of a triangle.
  TriangleMesh mesh;
  // Farthest that a vertex stands from the vertex of the input that it was made of.
  double expansion = 0.0;
};

// Convex hull of the vertices that triangles use, by qhull (Barber, Dobkin and Huhdanpaa 1996).
// Guarantee: the solid of the result (its surface and what it encloses) contains every vertex, so
// also all of the original and all that it encloses. qhull rounds, hence no answer of it is
// trusted: its vertices are moved away from a point c inside, by the same share each, until every
// input vertex lies strictly within the plane of every triangle by more than the rounding of the
// test, and c too. A path from c to an input vertex then intersects no triangle, so that both are
// inside. The share is some 1e-15, more for long and flat hulls.
//
// Throws Error for a mesh that validate() refuses; for a padding that is negative or not finite;
// for vertices that coincide, or lie on a line or a plane up to kFlatShare of their extent; for an
// extent below 1e-60; if no hull can be proved within max_expansion, or that is not above zero.
ConvexHull convex_hull(const TriangleMesh& mesh, const ConvexHullOptions& options = {});

// The convex hull of points, as that of the vertices of a mesh; errors name `subject`.
ConvexHull convex_hull(std::span<const Eigen::Vector3d> points, const ConvexHullOptions& options,
                       const std::string& subject);

// 0 to 3: whether points coincide, lie on a line, in a plane, or neither, up to kFlatShare of their
// extent (as seen along their principal axes).
int affine_dimension(std::span<const Eigen::Vector3d> points);

// Approximate convex decomposition: not conservative. The parts hold the whole surface of the mesh
// but not always what it encloses; where the surface is concave they stick out, unbounded by the
// concavity requested. measure_deviation() tells by how much.

// How far a mesh is taken apart.
struct ConvexDecompositionOptions {
  // Concavity at which parts are no longer joined, as HACD measures it: distance of the
  // surface of a part from its hull, in the unit of the mesh; 0: 1 % of the box diagonal.
  double max_concavity = 0.0;
  // No fewer parts than this are made of a mesh, if it has so many triangles.
  int min_parts = 1;
  // How the deviation is measured; nothing: not at all.
  std::optional<DeviationOptions> measure = DeviationOptions{};
};

// The parts, and how far they are from the mesh.
struct ConvexDecomposition {
  // Closed, convex up to rounding, facing outwards.
  std::vector<TriangleMesh> parts;
  double volume = 0.0;      // sum of the parts'; where they overlap it counts twice
  MeshDeviation deviation;  // of the parts together, measured; zero if not requested
};

// Shares the triangles out into parts by hierarchical clustering (Mamou and Ghorbel 2009), by HACD
// of Bullet's extras, and takes the convex hull of each, of all its triangles,
// instead of HACD's own, so that every point of the surface lies in a part. Triangles without area
// go with a neighbour. A part that is flat becomes a plate, 1e-4 of the box diagonal to either
// side. The time grows faster than the square of the triangles: decimate large meshes first.
// Equal input gives equal results. Throws Error for a mesh that validate() refuses or that has no
// triangle with an area, and for options out of range.
ConvexDecomposition decompose(const TriangleMesh& mesh,
                              const ConvexDecompositionOptions& options = {});

// All parts as one mesh, a component each.
TriangleMesh join_parts(const std::vector<TriangleMesh>& parts);

}  // namespace spherule
