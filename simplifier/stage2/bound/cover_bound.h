// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/solid/clearance.h"
#include "spheretree/progress.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <stop_token>

namespace spherule::internal {

struct CoverBoundInput {
  const Clearance& clearance;
  const MeshDistance& distance;
  double max_error;  // E
  // Points of S; those that are not found to be so, up to rounding, are left out.
  std::span<const Eigen::Vector3d> points;
  // Centres of spheres that a cover might use: the better they are, the better the bound.
  std::span<const Eigen::Vector3d> centers;
  // Once requested, what is proved so far is returned, 1 at least.
  std::stop_token stop = {};
  Progress progress = {};
};

// A lower bound of the number of spheres in any cover of S that protrudes from it by at most E
// (docs/covering.md): the value of a fractional packing. Weights are given to points of S so
// that no sphere that a cover may use holds points of more than weight 1 together; as the spheres
// of a cover hold every point, there are at least as many of them as all points weigh. Proved for
// every sphere, and not for a list of them: such a sphere with centre c has at most the radius D(c)
// + E, D the clearance to the outside of S, negative outside (where E is at most the radius of
// every external sphere: the outside of S grown by E is then the union of the external spheres
// shrunk by E), and space is subdivided into cells of centres, each standing for one sphere that
// holds all of its own. Zones only shrink spheres, and the bound stands. Returns 1 where E is
// larger than an external sphere.
std::size_t cover_bound(const CoverBoundInput& input);

}  // namespace spherule::internal
