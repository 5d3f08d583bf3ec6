// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <optional>

namespace spherule::internal {

// A cubic cell of the flood, and what is requested there.
struct PlaceCell {
  Eigen::Vector3d center;
  double half_edge;      // rounded up
  double half_diagonal;  // rounded up
  double least_radius;   // rho, the least in the cell
  double step;           // of the grid there: shorter than an edge of the cell
};

// One large sphere instead of the finest cells of a cell beside a surface that is flat or convex:
// free of the mesh grown by the padding, and it holds every point of the cell from which the
// surface is at least rho + padding away. For a point q of the surface the cell is proved to lie in
// the union of the sphere and the ball of radius rho + padding around q, and no point of the ball's
// interior is so far from the surface.
//
// The sphere touches the surface at q and leaves no more room beside it than the finest cells do:
// the height of the scallops between their spheres, at most step^2 / (4 rho), which at half a
// diagonal of a face from q is sampled. Empty where there is no such sphere, or none is found.
std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell);

}  // namespace spherule::internal
