// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "tests/support/polygon.h"

#include <Eigen/Geometry>

#include <span>
#include <vector>

namespace spherule {

// Makers of closed solids with outward triangles: every directed edge occurs once, and once the
// other way.

// The outline less the holes (as for triangulate()), from z = bottom to z = top.
TriangleMesh extrude(const Loop& outer, const std::vector<Loop>& holes, double bottom, double top);

// The profile, a loop in the half plane (r, z) with r >= 0, turned about the z axis. Corners with
// r = 0 become one vertex each.
TriangleMesh revolve(const Loop& profile, int sides);

// A closed tube of `sides` around a path, flat at both ends; one radius a point of the path.
TriangleMesh tube_along(std::span<const Eigen::Vector3d> path, std::span<const double> radii,
                        int sides);

// Exact quarter and third turns. kProfileXz stands an extrusion up: x stays, the outline's y
// becomes z, the thickness runs along -y. kAlongX and kAlongY lay the z axis of a solid of
// revolution along x and y.
Eigen::Matrix3d profile_xz();
Eigen::Matrix3d along_x();
Eigen::Matrix3d along_y();

// The mesh turned, then shifted.
TriangleMesh placed(TriangleMesh mesh, const Eigen::Matrix3d& turn, const Eigen::Vector3d& shift);
TriangleMesh shifted(TriangleMesh mesh, const Eigen::Vector3d& shift);

// Adds the triangles of `other` as shells of their own (they may overlap what is there).
void append(TriangleMesh& mesh, const TriangleMesh& other);

// Splits the longest edge at its middle, again and again, each time turning its two triangles into
// four, until the mesh has `count` triangles. The surface stays the same set of points (up to
// rounding of the midpoints) and closed. Throws Error if the mesh is not closed, has more than
// `count` triangles, or an odd number is lacking.
void refine_to(TriangleMesh& mesh, std::size_t count);

// Rounds every coordinate to a multiple of 2^-22, of 0.24 micrometres in metres. Coordinates below
// 4 are then exact as 32-bit floats, so that engines in single and double precision and files see
// the same mesh, and the last bits of the library's sine do not show.
void snap(TriangleMesh& mesh);

}  // namespace spherule
