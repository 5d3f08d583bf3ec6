// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_set.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace spherule::internal {

// Finds the point of S that is furthest from a growing set of spheres, with proved bounds:
// best-first subdivision of the box of S. A cell with centre q and half diagonal g is at most
// min(|q - c| - r) + g from the spheres everywhere; cells that lie outside of S, or within the
// target, are dropped for good, since spheres are only added. Bounds that are out of date are upper
// bounds, so a cell is brought up to date only when it comes to the top.
class UncoveredSearch {
 public:
  // `target`: errors up to this are not of interest. The greatest error is bracketed to within
  // `tolerance`, or a tenth of what it exceeds the target by if that is more.
  UncoveredSearch(const Clearance& clearance, const MeshDistance& distance, double target,
                  double tolerance);

  struct Peak {
    // In S, up to the rounding of points of the mesh; or, where no point of S could be found near a
    // cell that is too small to be halved (solid_query.h), the centre of that.
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double upper = 0.0;  // no point of S is further from the spheres
    double lower = 0.0;  // some point of S is this far from them
  };

  // The furthest point for the spheres as they are now; `upper` is the target where none exceeds it
  // (then `point` means nothing and `lower` is 0).
  Peak next(const SphereSet& spheres);

 private:
  struct Cell {
    BoxCell box;
    double upper;
    std::uint64_t order;  // ties are broken by age
    bool inside;          // the cell is wholly in S
  };
  // For a cell of S with its centre outside of S, small enough to stand for a peak; none if it has
  // to be halved.
  std::optional<Peak> peak_beside(const Cell& cell, const SphereSet& spheres) const;
  void push(const Cell& cell);
  Cell pop();

  const Clearance& clearance_;
  const MeshDistance& distance_;
  double target_;
  double tolerance_;
  std::vector<Cell> heap_;
  std::uint64_t made_ = 0;
};

}  // namespace spherule::internal
