// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/internal/box_cell.h"
#include "simplifier/internal/clearance.h"
#include "simplifier/internal/proof.h"
#include "simplifier/mesh_distance.h"

#include <Eigen/Core>

#include <vector>

namespace spherule::internal {

// A partition of S into cells, kept between rounds of a search: which cells meet S does not depend
// on the balls, and finding that out is what costs.
class SolidCells {
 public:
  // Halves the box of S until a cell lies outside of S (it is forgotten) or its half diagonal is at
  // most `spacing`, or half the clearance where that is more: a ball that covers part of the deep
  // inside covers much of it.
  SolidCells(const Clearance& clearance, const MeshDistance& distance, double spacing);

  // A point of S for every cell: the centre, moved onto the boundary of S where that crosses the
  // cell. Cells without such a point near their centre give none.
  std::vector<Eigen::Vector3d> sample() const;

  // Points where the balls do not cover S, at most one per cube of edge `spacing`. Empty only if S
  // is proved to be covered: cells that no single ball contains are halved until one does, or they
  // lie outside of S. A cell is given up as a leak where its centre is an uncovered point of S or
  // it is smaller than `finest` (a small share of that where its centre is not in S).
  std::vector<Eigen::Vector3d> find_leaks(const BallsToProve& balls, double finest, double spacing);

 private:
  struct Cell {
    BoxCell box;
    bool inside;         // wholly in S
    bool center_inside;  // the centre is in S
  };
  struct Refined {
    std::vector<Cell> cells;
    std::vector<Eigen::Vector3d> leaks;
  };

  bool meets_solid(Cell& cell) const;
  Refined refine(const Cell& cell, const BallsToProve& balls, double finest) const;

  const Clearance& clearance_;
  const MeshDistance& distance_;
  std::vector<Cell> cells_;
};

}  // namespace spherule::internal
