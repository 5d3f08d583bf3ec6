// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/stage1/flood_grid.h"
#include "simplifier/types/simplification.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <span>
#include <vector>

namespace spherule::internal {

struct RandomPlacement {
  std::vector<Sphere> spheres;
  std::size_t attempts = 0;
};

// External spheres as in the paper's Algorithm 1, first loop: a sphere of radius `rho` at a random
// position is dropped if it intersects the mesh, else it grows in place until it touches.
//
// Departures from the listing: positions are drawn from `box` grown by rho, so that spheres can sit
// against its faces; `limit` counts attempts, since a model that fills its box would never yield
// the wanted number; and a sphere is kept only if a sphere of radius rho gets to it from outside
// the box through other kept spheres, a step from x to y counting if (d(x) + d(y) - |x - y|) / 2 >=
// rho. The listing would also fill closed hollows.
//
// Takes `limit`, `seed` and `progress` from the options.
RandomPlacement place_random(const MeshDistance& distance, double padding, double rho,
                             const Eigen::AlignedBox3d& box, const ExternalOptions& options);

// Makes external spheres sit close to concave edges, corners and ends of passages, which the grid
// reaches only by chance: points of a cell beside a reached node are pushed away from the surface
// until a sphere of radius rho has room, and the sphere is kept if it takes something from S there,
// that is, in the direction from which it was pushed, and provably gets there from the node.
class ConcaveFitSpheres {
 public:
  // `reached`: the spheres of the grid.
  ConcaveFitSpheres(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
                    std::span<const Sphere> reached)
      : distance_(distance),
        padding_(padding),
        displacement_(distance, padding),
        diameter_(diameter),
        reached_(reached) {}

  std::vector<Sphere> operator()(const FloodGrid::Frontier& frontier) const;

 private:
  // What came of a point.
  struct Pushed {
    Sphere sphere;            // of radius 0 where nothing is to be had
    bool is_flat = true;      // one surface only was met, if any
    double to_surface = 0.0;  // upper bound of the distance from the point, up to rounding
  };

  // From a point, and, unless only a wall is there that the grid does as well for, from eight
  // around it, and around those that find a sphere. The surface is at most `to_surface` away.
  void sample(const FloodGrid::Frontier& frontier, const Eigen::Vector3d& start, double to_surface,
              double apart, std::vector<Sphere>& found) const;

  Pushed pushed(const FloodGrid::Frontier& frontier, const Eigen::Vector3d& start,
                double to_surface, std::span<const Sphere> found) const;

  // Whether the point of the sphere towards `start` is this far from all others.
  bool takes_something(const Sphere& sphere, const Eigen::Vector3d& start, double step,
                       const Sphere& node, std::span<const Sphere> found) const;

  const MeshDistance& distance_;
  double padding_;
  SphereDisplacement displacement_;
  const LocalDiameter& diameter_;
  SphereHierarchy reached_;
};

}  // namespace spherule::internal
