// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/stage1/flood_grid.h"
#include "simplifier/stage1/local_diameter.h"
#include "simplifier/stage1/sphere_displacement.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace spherule::internal {

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
