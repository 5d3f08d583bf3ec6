// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/solid/box_cell.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <optional>

namespace spherule::internal {

// A cubic cell of the flood, and which spheres and grid step are required there. A *place* is a
// point from which the surface is at least rho + padding away.
struct PlaceCell {
  BoxCell box;             // a cube
  double rho;              // no more than any point of the cell requires
  double step;             // of the grid there: shorter than an edge of the cell
  double surface_at_most;  // upper bound of the distance of the surface from the centre
};

// One large sphere instead of the finest cells of a cell beside a surface that is flat or convex.
// It touches the surface, up to the height of the scallops between the spheres of finest cells,
// step^2 / (4 rho), and at half a diagonal of a face from there, in four directions, the surface is
// no further from it than that.
struct SphereOfPlaces {
  Sphere sphere;
  Eigen::Vector3d foot;    // the point of the surface nearest to the centre of the cell
  Eigen::Vector3d normal;  // from there to the centre
};

// A sphere that would hold the places of a cell if it were free of the mesh grown by the padding.
// Empty where the cell is not suitable.
std::optional<SphereOfPlaces> wanted_sphere(const MeshDistance& distance, double padding,
                                            const PlaceCell& cell);

// What is left of a wanted sphere: free of the mesh grown by the padding, and it holds every place
// of the cell. For a point q of the surface the cell is proved to lie in the union of the sphere
// and the ball of radius rho + padding around q, and there is no place in that ball's interior.
// Empty where there is no such sphere, or to find out would take long.
std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell, const SphereOfPlaces& wanted);

}  // namespace spherule::internal
