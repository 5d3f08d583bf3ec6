// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/external_spheres.h"
#include "simplifier/internal/local_diameter.h"
#include "simplifier/mesh_distance.h"

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// The free space of a ball of radius rho around a mesh, as a sparse octree over a cube that leaves
// the ball room on every side of the mesh; rho and the finest step h are those of the place
// (local_diameter.h). Cells are examined from coarse to fine, so that memory grows with the surface
// over the square of the finest step, not with the volume:
//  - a coarse cell all of whose points have clearance >= rho + 1.2 h is free as a whole;
//  - a cell all of whose points have clearance < rho is blocked;
//  - a finest cell, of edge h, is a node: free if the clearance at its centre is at least rho.
// Clearance is the proved lower bound of the distance to the mesh, less the padding.
class FloodGrid {
 public:
  struct Cell {
    Eigen::Vector3d center;
    double clearance = 0.0;  // lower bound at the centre
  };
  // A finest cell that was not reached beside one that was.
  struct Frontier {
    Eigen::Vector3d center;
    Cell neighbour;
    double step = 0.0;  // h there
  };
  struct Shape {
    Eigen::Vector3d origin;  // low corner of the cube
    double step = 0.0;       // h, where no zone halves it
    int levels = 0;          // the cube has the edge h * 2^levels; with the halvings at most 20
  };

  // `progress` is called after every level. The share takes the finest level for nine tenths of the
  // work and each coarser one for a quarter of the next: cells near the surface grow that fast.
  FloodGrid(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
            const Shape& shape, const Progress& progress);

  // Marks the cells that the ball reaches from outside the cube. A step between two nodes counts
  // only if the ball provably passes on the straight way, whose length is h: (d1 + d2 - h) / 2 >=
  // rho, the greatest on that way. A step between two coarse free cells always passes, through
  // their common face. So does one between a node and a coarse free cell where rho is the same: on
  // the way of h / 2 to the common face the clearance is at least (d1 + rho + 1.2 h - h / 2) / 2 >=
  // rho. Where zones make a difference, that way is examined.
  void flood();

  // After flood(). Order: from coarse to fine, along the Morton curve.
  std::vector<Cell> reached_cells() const;
  // The same but for nodes whose ball lies in that of a cell beside it, up to 1e-9 of the step:
  // such chains end at a larger ball that is kept.
  std::vector<Cell> reached_cells_that_count() const;
  std::vector<Frontier> frontier() const;

  // Distances computed; all of them are kept, 24 bytes each.
  std::size_t evaluations() const { return cells_.size(); }

 private:
  enum class State : std::uint8_t { kBlocked, kRefined, kFree };
  using Index = std::array<std::uint32_t, 3>;
  struct Entry {
    std::uint64_t code = 0;  // Morton code of the index within its level
    double clearance = 0.0;
    // If refined, the first of its eight consecutive children; if finest, the zone that says how
    // much room is needed at the centre (LocalDiameter::at).
    std::uint32_t child_or_zone = 0;
    State state = State::kBlocked;
    std::uint8_t level = 0;
    bool finest = false;
    bool reached = false;
  };

  double edge(int level) const;
  // Bound on the rounding of the coordinates of centres and faces.
  double rounding() const;
  Eigen::Vector3d center(int level, const Index& index) const;
  Eigen::Vector3d center(const Entry& cell) const;
  void examine(const MeshDistance& distance, int level);
  // The cell of `level` or coarser that holds the index and is not refined; cells_.size() if that
  // one is refined further.
  std::size_t locate(int level, const Index& index) const;
  // Whether the ball of a reached node lies in that of a reached neighbour, of its size or coarser.
  bool lies_in_neighbour(const Entry& node) const;
  // The same answer as from LocalDiameter::on_way(), between the centres of two nodes.
  double needed_between(const Entry& a, const Entry& b) const;
  // Whether the ball provably passes between two free cells that share a face; `face` is the centre
  // of that.
  bool passes(const Entry& a, const Entry& b, const Eigen::Vector3d& face) const;
  // Calls visit(cell, index) for the face neighbours of the same size or coarser, and
  // visit(cells_.size(), index) for each face on the boundary of the cube.
  template <typename Visit>
  void for_each_face_neighbour(int level, const Index& index, Visit visit) const;

  double padding_;
  const LocalDiameter& diameter_;
  Shape shape_;
  int levels_;  // with the halvings of zones
  std::vector<Entry> cells_;
  std::vector<std::size_t> level_begin_;
};

}  // namespace spherule::internal
