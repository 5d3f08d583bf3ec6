// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "mesh/shells/disjoint_sets.h"
#include "simplifier/external_spheres.h"
#include "simplifier/stage1/local_diameter.h"
#include "simplifier/stage1/sphere_way.h"

#include <Eigen/Geometry>

#include <array>
#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace spherule::internal {

// The free space of a sphere of radius rho around a mesh, as a sparse octree over a cube that
// leaves the sphere room on every side of the mesh; rho and the finest step h are those of the
// place (local_diameter.h). Cells are examined from coarse to fine, so that memory grows with the
// surface over the square of the finest step, not with the volume:
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
  // A finest cell that was not reached near one that was: beside it, or with a ring or two of such
  // cells between the two that are as near to it.
  struct Frontier {
    Eigen::Vector3d center;
    Cell neighbour;
    double step = 0.0;  // h there
  };
  struct Shape {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // low corner of the cube
    double step = 0.0;                                 // h, where no zone halves it
    int levels = 0;              // the cube has the edge h * 2^levels; with the halvings at most 20
    std::size_t grid_cells = 0;  // at most, as it is made
    std::size_t max_cells = 0;   // at most, as tighten() leaves it
  };

  // `progress` is called after every level and between parts of it. The share takes the finest
  // level for nine tenths of the work and each coarser one for a quarter of the next: cells near
  // the surface grow that fast. Throws TooManyCells as soon as more
  // than `grid_cells` are foreseen.
  FloodGrid(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
            const Shape& shape, const Progress& progress);

  // Marks the cells that the sphere reaches from outside the cube. A step between two nodes counts
  // only if the sphere provably passes on the straight way, whose length is h: (d1 + d2 - h) / 2 >=
  // rho, the greatest on that way; or, where that makes a difference, by bisection (sphere_way.h).
  // A step between two coarse free cells always passes, through their common face. So does one
  // between a node and a coarse free cell where rho is the same: on the way of h / 2 to the common
  // face the clearance is at least (d1 + rho + 1.2 h - h / 2) / 2 >= rho. Where zones make a
  // difference, that way is examined.
  void flood();

  // After flood(): halves cells where a sphere that is larger by a share might get to places that
  // are not reached yet, until it is proved that there are none, and floods on. Returns the share s
  // for which this holds, `share` unless memory is short: wherever a sphere of radius (1 + s) rho
  // can be moved from outside the cube, its centre lies in a reached cell, or in the sphere of a
  // reached cell that touches its own. The proof is in flood_refinement.cpp.
  double tighten(double share, const Progress& progress);

  // After flood(). Order: from coarse to fine, along the Morton curve.
  std::vector<Cell> reached_cells() const;
  // The same but for nodes whose sphere lies in that of a cell beside it, up to 1e-9 of the step:
  // such chains end at a larger sphere that is kept.
  std::vector<Cell> reached_cells_that_count() const;
  std::vector<Frontier> frontier() const;

  // Distances computed; all of them are kept, 24 bytes each.
  std::size_t evaluations() const { return cells_.size(); }

 private:
  // Morton codes have room for 21.
  static constexpr int kMostLevels = 20;

  enum class State : std::uint8_t { kBlocked, kRefined, kFree };
  using Index = std::array<std::uint32_t, 3>;
  // The index of a Morton code: every third of its bits, from each of the three on.
  static Index decode(std::uint64_t code) {
    return {gather(code), gather(code >> 1), gather(code >> 2)};
  }
  static std::uint32_t gather(std::uint64_t x) {
    x &= 0x1249249249249249;
    x = (x ^ x >> 2) & 0x10c30c30c30c30c3;
    x = (x ^ x >> 4) & 0x100f00f00f00f00f;
    x = (x ^ x >> 8) & 0x1f0000ff0000ff;
    x = (x ^ x >> 16) & 0x1f00000000ffff;
    x = (x ^ x >> 32) & 0x1fffff;
    return static_cast<std::uint32_t>(x);
  }
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

  double edge(int level) const { return edges_[static_cast<std::size_t>(level)]; }
  // Bound on the rounding of the coordinates of centres and faces.
  double rounding() const { return rounding_; }
  Eigen::Vector3d center(int level, const Index& index) const {
    return shape_.origin +
           edge(level) * Eigen::Vector3d(index[0] + 0.5, index[1] + 0.5, index[2] + 0.5);
  }
  Eigen::Vector3d center(const Entry& cell) const { return center(cell.level, decode(cell.code)); }
  // Appends the eight children of a cell, which are to be examined.
  void halve(std::size_t cell);
  // Measures and classifies the cells of a level, which are the last.
  void examine_level(int level, const Progress& progress);
  // The same for cells from one on, up to another.
  void examine(std::size_t begin, std::size_t end);
  // Throws TooManyCells for those that the last level is halved into, or those of the finest that
  // are foreseen.
  void check_memory(int level) const;
  void classify(Entry& cell, const Eigen::Vector3d& middle, const SurfaceDistance& d) const;
  // From the centre to a corner, and all that rounding adds.
  double half_diagonal(int level) const;
  // The cell of `level` or coarser that holds the index and is not refined; cells_.size() if that
  // one is refined further.
  std::size_t locate(int level, const Index& index) const;
  // Whether the sphere of a reached node lies in that of a reached neighbour, of its size or
  // coarser.
  bool lies_in_neighbour(const Entry& node) const;
  // The same answer as from LocalDiameter::on_way(), between the centres of two nodes.
  double needed_between(const Entry& a, const Entry& b) const;
  // Whether the sphere provably passes between two free cells that share a face; `face` is the
  // centre of that.
  bool passes(const Entry& a, const Entry& b, const Eigen::Vector3d& face) const;
  // Calls visit(cell, index) for the face neighbours of the same size or coarser, and
  // visit(cells_.size(), index) for each face on the boundary of the cube.
  template <typename Visit>
  void for_each_face_neighbour(int level, const Index& index, Visit visit) const;
  // The same between the centres, by bisection.
  bool passes_by_bisection(const Entry& a, const Entry& b) const;
  // Two free cells.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  // Unites a free cell with the free ones at its faces to which the sphere passes by passes(), and
  // notes the others as uncertain.
  void connect(std::size_t cell);
  // Unites the uncertain pairs of which one alone is reached and between which the sphere passes by
  // bisection, as long as there are some, and marks what is reached. Those between two cells that
  // are not reached are left.
  void reach_on();

  static std::uint32_t element(std::size_t cell) { return static_cast<std::uint32_t>(cell + 1); }
  bool is_reached(std::size_t cell) { return sets_.find(element(cell)) == sets_.find(0); }

  class Refinement;

  const MeshDistance& distance_;
  double padding_;
  SphereWay way_;
  const LocalDiameter& diameter_;
  Shape shape_;
  std::array<double, kMostLevels + 1> edges_{};  // of the cells of each level
  double rounding_ = 0.0;
  int levels_;  // with the halvings of zones
  std::vector<Entry> cells_;
  std::vector<std::size_t> level_begin_;
  std::atomic<double> widest_bounds_ = 0.0;  // of distances: upper less lower
  // Of the outside, 0, and each cell, one further: between which the sphere passes.
  DisjointSets sets_{1};
  std::vector<Pair> uncertain_;
};

}  // namespace spherule::internal
