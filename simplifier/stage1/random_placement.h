// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/external_spheres.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <cstddef>
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

}  // namespace spherule::internal
