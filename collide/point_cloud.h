// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres that stand for measured points.
//
// @code{.cpp}
// #include <spherule/collide/point_cloud.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<Eigen::Vector3d> points{{0, 0, 0}, {0.01, 0, 0}, {1, 0, 0}};
// const auto all = spherule::point_cloud_spheres(points, 0.05);
// const auto few = spherule::point_cloud_spheres(points, 0.05, {.voxel = 0.1});
// assert(all.size() == 3 && few.size() == 2);
// assert(spherule::point_cloud_tree(points, 0.05).spheres().size() == 3);
// @endcode

#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace spherule {

// How points become spheres.
struct PointCloudOptions {
  // Side of the cubic cells of which each is left one sphere, in the unit of the points; 0 keeps
  // every point.
  double voxel = 0.0;
  BuildOptions build = {};
};

// Spheres that stand for points measured on surfaces: a sphere of `radius` about every point,
// points that are equal being merged. Surfaces are without gaps only if the radius is large enough
// for how far apart the points lie, which is the caller's to know.
//
// With cells, one sphere for those of a cell: it contains the spheres of all its points in exact
// arithmetic, and protrudes from their union by at most sqrt(3) times the cell's side, up to
// rounding. Sorted by cell and point, so that the order of the points does not matter.
//
// Throws Error if there are no points, one has a coordinate that is not finite or beyond
// kMaxCoordinate (naming its index), or the radius or the side of the cells is not finite, negative
// or beyond kMaxCoordinate.
std::vector<Sphere> point_cloud_spheres(std::span<const Eigen::Vector3d> points, double radius,
                                        const PointCloudOptions& options = {});

// The tree over them. Throws Error, too, as build_tree() does.
SphereTree point_cloud_tree(std::span<const Eigen::Vector3d> points, double radius,
                            const PointCloudOptions& options = {});

}  // namespace spherule
