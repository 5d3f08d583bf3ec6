// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/stage2/cover_problem.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// A partition of S into cells, kept between rounds of a search: which cells meet S does not depend
// on the spheres, and finding that out is what costs.
class SolidCells {
 public:
  // Halves the box of S until a cell lies outside of S (it is forgotten) or its half diagonal is at
  // most the `share` of E plus half the clearance, since a sphere that covers part of the deep
  // inside covers much of it, or the share of how far spheres reach along the boundary there
  // (`widest_cap` times E at most). So the number of cells grows with the edges
  // and thin parts of S over E, and where S is flat only with its area over E times the radius of
  // the largest spheres in it. This and the other lengths below hold where E does, and shrink with
  // the error in zones.
  SolidCells(const Clearance& clearance, const MeshDistance& distance, const LocalError& error,
             double max_error, double share, double widest_cap = kWidestCap);
  // The same of the part of S in these cells alone, which the search and the proof are then about.
  SolidCells(const Clearance& clearance, const MeshDistance& distance, const LocalError& error,
             double max_error, double share, std::span<const BoxCell> part,
             double widest_cap = kWidestCap);

  std::size_t size() const { return cells_.size(); }
  std::vector<BoxCell> boxes() const;

  // A point of S for every cell: the centre, moved onto the boundary of S where that crosses the
  // cell; there at most one per cube of about a cell's size. Cells without such a point near their
  // centre give none.
  std::vector<Eigen::Vector3d> sample() const;

  // Where the spheres do not cover S, at most one point per cube of edge `spacing`. None only if S
  // is proved to be covered: cells are halved until a single sphere contains what S has in them,
  // or they lie outside of S. A cell is given up as a leak where its centre is an uncovered point
  // of S or it is smaller than `finest` (much smaller where no point of S is found near its
  // centre).
  struct Leaks {
    std::vector<Eigen::Vector3d> in_solid;
    // Cells that external spheres only just close, if at all: no point of S is known near these.
    std::vector<Eigen::Vector3d> pinched;
    bool empty() const { return in_solid.empty() && pinched.empty(); }
  };
  Leaks find_leaks(const SpheresToProve& spheres, double finest, double spacing);

 private:
  struct Cell {
    BoxCell box;
    bool inside = false;              // wholly in S
    bool center_inside = false;       // the centre is in S
    bool classified = false;          // whether these two and the contact are known
    std::int32_t sphere = -1;         // the nearest when it was last searched for
    const Sphere* contact = nullptr;  // of CellState, where the cell is not wholly in S

    void note(const CellState& state);
  };
  struct Leak {
    Eigen::Vector3d point;
    bool in_solid;
  };
  struct Refined {
    std::vector<Cell> cells;
    std::vector<Leak> leaks;
  };

  bool intersects_solid(Cell& cell) const;
  // Has the cells' spheres name those of another set, by the nearest centre: most cells lie in the
  // sphere that contained them the last time, or in what has become of it.
  void follow(std::span<const Sphere> spheres);
  // The cell as a leak, if it is one or too small to tell; `gap` is its centre's to the spheres.
  std::optional<Leak> leak_in(const Cell& cell, const NearestSphere& gap, double finest) const;
  Refined refine(const Cell& cell, const SpheresToProve& spheres, double finest) const;

  const Clearance& clearance_;
  const MeshDistance& distance_;
  const LocalError& error_;
  double spacing_;           // the share of E
  std::vector<Cell> first_;  // as made
  std::vector<Cell> cells_;
  std::vector<Sphere> spheres_before_;  // to which the cells' numbers refer
};

}  // namespace spherule::internal
