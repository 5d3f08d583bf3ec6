// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/cover.h"

#include <vector>

namespace spherule::internal {

// Measures, over fixed samples, how a growing set of spheres fits the original mesh (the paper's
// figures 6 to 8). Estimates, not proofs: the solid is where the winding number rounds to another
// number than zero.
class CoverHistory {
 public:
  // `box` holds the solid; spheres may protrude from it by `margin`.
  CoverHistory(const TriangleMesh& mesh, const MeshDistance& distance,
               const Eigen::AlignedBox3d& box, double margin, std::uint64_t seed);

  void add(const Sphere& sphere);

  // The state now; inflating every sphere by `inflation` gives the "after" figures.
  CoverHistoryEntry entry(double inflation) const;

 private:
  struct Sample {
    Eigen::Vector3d point;
    double gap;  // least |p - c| - r so far
  };
  static void update(std::vector<Sample>& samples, const Sphere& sphere);

  std::vector<Sample> surface_;
  std::vector<Sample> solid_;
  std::vector<Sample> outside_;
  std::size_t count_ = 0;
};

}  // namespace spherule::internal
