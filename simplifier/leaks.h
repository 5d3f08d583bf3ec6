// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where a mesh sticks out of spheres, for showing where to look.

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// A point of a surface that no sphere contains.
struct LeakPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // on the surface, up to its rounding
  // Lower bound of the distance from `point` to the nearest sphere; positive.
  double depth = 0.0;
};

// How closely leaks are searched for.
struct LeakPointOptions {
  // How far the samples are apart and how far those returned, as shares of the diagonal of the
  // mesh's box; positive. Samples are no closer than 2^-40 of the largest coordinate.
  double spacing = 1.0 / 400.0;
  double separation = 1.0 / 25.0;
  std::size_t max_count = 500;  // the deepest are returned
};

// Where the surface of a mesh is outside of all spheres, the deepest point first: for showing where
// to look. Every point returned is a leak. That none is returned proves nothing, since only samples
// are examined: certify() proves. Without any sphere there is no depth to tell, and nothing is
// returned. Equal input gives equal output. Throws Error for a mesh that validate() refuses,
// spheres that are not usable, and options out of range.
std::vector<LeakPoint> leak_points(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                   const LeakPointOptions& options = {});

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
