// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/rounding.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/zone_index.h"
#include "simplifier/types/simplification.h"
#include "simplifier/types/zones.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// D as a function of place, as radii, and the grid steps that follow it. At a point x a sphere of
// radius rho(x) has to have room: D / 2, or d / 2 in a zone of its own d, the least of them where
// zones overlap. Zones are closed and convex, so the segment between two points of one zone
// needs no more than that zone requires.
class LocalDiameter {
 public:
  // A zone's grid step is `step` halved as often as it takes to be no longer than
  // `zone_steps[i]`.
  LocalDiameter(double diameter, double step, std::span<const Zone> zones,
                std::span<const double> zone_steps);

  // Where no zone requires less.
  double radius() const { return radius_; }
  // What a zone requires.
  double radius_of(std::uint32_t zone) const { return parts_[zone].radius; }
  // Of all places.
  double least_radius() const { return least_radius_; }

  // A radius with the number of the zone that requires it, kNoZone if none does.
  struct Needed {
    double radius;
    std::uint32_t zone;
  };
  static constexpr std::uint32_t kNoZone = 0xffffffff;

  // Never less than rho at the point (rounding may take it for a point beside a zone).
  Needed at(const Eigen::Vector3d& point) const { return needed(point, point); }
  // Never less than rho at any point of the segment: of the zones that hold both ends, the
  // least that one requires. It is at least what at() says of either end, and just that if both
  // ends need it by the same zone, or one of them by none.
  double on_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return needed(from, to).radius;
  }
  // Of all points within `reach` of the center: never more than the least rho, and never less than
  // the greatest; and how often the grid step is to be halved for them.
  struct Near {
    double least;
    double greatest;
    int halvings;
  };
  Near near(const Eigen::Vector3d& center, double reach) const;

  // Of all zones.
  int most_halvings() const { return most_halvings_; }

 private:
  struct Part {
    double radius;
    int halvings;
  };

  Needed needed(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  double radius_;
  double least_radius_;
  int most_halvings_ = 0;
  ZoneIndex zones_;
  std::vector<Part> parts_;  // as the zones
};

// The grid of stage 1 would have more cells than it may.
class TooManyCells : public Error {
 public:
  // So many cells, of this edge the finest, are foreseen, the least if most large ones need not be
  // halved. The reason says what to choose so that memory suffices for the most.
  TooManyCells(double most_foreseen, double least_foreseen, double edge, std::size_t max_cells);
  // How many times longer the edges of the cells have to be, with a margin: above 1. The least
  // number goes with the area of the surface over their square.
  double coarsening() const { return coarsening_; }

 private:
  double coarsening_;
};

// Whether a sphere of radius rho can provably be displaced along the segment between the centres of
// two spheres that are free of the mesh grown by the padding: by bisection, up to 2^8 pieces. On a
// piece of length g between clearances c1 and c2 the clearance is at least (c1 + c2 - g) / 2. It
// fails only where the clearance comes below rho + (length of the displacement) / 2^8 somewhere.
class SphereDisplacement {
 public:
  // Of a bound of a distance that is passed to MeshDistance as a limit: usually more than all
  // roundings. Where it is not, the limit is returned as the lower bound: true, but less room.
  static constexpr double kLimitUp = 1.0 + 1e-5;

  SphereDisplacement(const MeshDistance& distance, double padding)
      : distance_(distance), padding_(padding) {}

  static constexpr int kMostBisections = 8;
  bool is_free(const Sphere& a, const Sphere& b, double rho,
               int bisections = kMostBisections) const {
    const double gap = distance_upper(a.center, b.center);
    if (sub_down(add_down(a.radius, b.radius), gap) >= 2.0 * rho * kRelativeUp) return true;
    if (bisections == 0) return false;
    Sphere middle{(a.center + b.center) / 2.0, 0.0};
    // Usually the surface is no further from there.
    const double limit = (std::min(a.radius, b.radius) + padding_ + 0.5 * gap) * kLimitUp;
    middle.radius = sub_down(distance_(middle.center, limit).lower, padding_);
    return middle.radius >= rho && is_free(a, middle, rho, bisections - 1) &&
           is_free(middle, b, rho, bisections - 1);
  }

 private:
  const MeshDistance& distance_;
  double padding_;
};

// The free space of a sphere of radius rho around a mesh, as a sparse octree over a cube that
// leaves the sphere room on every side of the mesh; rho and the finest step h are those of the
// place (LocalDiameter). Cells are examined from coarse to fine, so that memory grows with the
// surface over the square of the finest step, not with the volume:
//  - a coarse cell all of whose points have clearance >= rho + 1.2 h is free as a whole;
//  - a cell all of whose points have clearance < rho is blocked;
//  - a finest cell, of edge h, is a node: free if the clearance at its centre is at least rho;
//  - a larger one beside a flat or convex surface has a sphere of its own, if one is found that
//    holds every point of clearance >= rho in the cell (SphereOfPlaces), and whose centre lies
//    in a free coarse cell or outside of the cube. It is reached if its sphere is, and is not
//    halved.
// No cell is halved that blocked ones separate from the outside, as inside of a closed part.
// Clearance is the proved lower bound of the distance to the mesh, less the padding.
class FloodGrid {
 public:
  // A finest cell that was not reached near one that was: beside it, or with a ring or two of such
  // cells between the two that are as near to it.
  struct Frontier {
    Eigen::Vector3d center;
    Sphere neighbour;   // about the centre of that cell
    double step = 0.0;  // h there
  };
  // What of the reached cells near the border of a zone counts as within the larger sphere's reach
  // in tighten(): all, which is quick and suffices for most, or what a way of its own leads to.
  enum class ZoneBorders : std::uint8_t { kOpen, kFollowed };
  struct Shape {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // low corner of the cube
    double step = 0.0;                                 // h, where no zone halves it
    int levels = 0;              // the cube has the edge h * 2^levels; with the halvings at most 20
    std::size_t grid_cells = 0;  // at most, as it is made
    std::size_t max_cells = 0;   // at most, as tighten() leaves it
    bool own_spheres = true;     // whether cells may have them
  };

  // `progress` is called after every level and between parts of it. The share takes the finest
  // level for nine tenths of the work and each coarser one for a quarter of the next: cells near
  // the surface grow that fast. Throws TooManyCells as soon as more
  // than `grid_cells` are foreseen.
  FloodGrid(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
            const Shape& shape, const Progress& progress);

  // Marks the cells that the sphere reaches from outside the cube. A step between two nodes counts
  // only if the sphere provably passes along the segment between their centres, whose length is h:
  // (d1 + d2 - h) / 2 >= rho, the greatest on that segment; or, where that makes a difference, by
  // bisection (SphereDisplacement). A step between two coarse free cells always passes, through
  // their common face. So does one between a node and a coarse free cell where rho is the same: on
  // the segment of h / 2 to the common face the clearance is at least half of d1 + rho + 0.7 h, so
  // at least rho. Where zones make a difference, that segment is examined.
  void flood();

  // After flood(): halves cells where a sphere that is larger by a share might get to places that
  // are not reached yet, until it is proved that there are none, and floods on. Returns the share s
  // for which this holds, `share` unless halving ends before that is proved: wherever a sphere of
  // radius (1 + s) rho can be moved from outside the cube, its centre lies in a reached cell, or in
  // the sphere of a reached cell that touches its own. The proof is in flood_refinement.cpp. None
  // if cells with own spheres prevent a proof for any s that holds without them, or with kOpen if
  // zones prevent one.
  std::optional<double> tighten(double share, ZoneBorders borders, const Progress& progress);

  // After flood(): a sphere for each reached cell, its own or about its centre. Order: from coarse
  // to fine, along the Morton curve.
  std::vector<Sphere> reached_spheres() const;
  // The same but for nodes whose sphere lies in that of a cell beside it, up to 1e-9 of the step:
  // such chains end at a larger sphere that is kept.
  std::vector<Sphere> reached_spheres_that_count() const;
  std::vector<Frontier> frontier() const;

  // Whether D follows the place.
  bool has_zones() const { return diameter_.least_radius() < diameter_.radius(); }
  // Cells examined; all of them are kept, 24 bytes each.
  std::size_t cells_examined() const { return cells_.size(); }

 private:
  // Morton codes have room for 21.
  static constexpr int kMostLevels = 20;

  // Mixed: neither blocked nor free as a whole.
  enum class State : std::uint8_t { kBlocked, kMixed, kRefined, kFree, kOwnSphere };
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
    // If refined, the first of its eight consecutive children; if it has a sphere of its own, the
    // index of that; if finest, the zone that says how much room is needed at the centre
    // (LocalDiameter::at).
    std::uint32_t index = 0;
    State state = State::kBlocked;
    std::uint8_t level = 0;
    bool finest = false;
    bool reached = false;
    bool has_sphere() const { return state == State::kFree || state == State::kOwnSphere; }
  };
  // Of a cell with a sphere of its own.
  struct OwnSphere {
    Sphere sphere;
    std::uint32_t around = 0;  // element of the free cell that holds its centre, or of the outside
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
  // Measures and classifies the cells of a level: those from the first on.
  void examine_level(int level, std::size_t first, const Progress& progress);
  // The same for cells from one on, up to another.
  void examine(std::size_t begin, std::size_t end);
  // The same for the last cells, from one on, and for those that they are halved into.
  void examine_and_halve(std::size_t begin);
  // Of the cells from one on, which are the last, those that are to be halved: mixed, without a
  // sphere of their own (this looks for them), and connected with the outside of the cube through
  // faces of cells that are not blocked, as the sphere gets to no other. `lasting` connects what is
  // not halved of all levels, and is carried on.
  std::vector<std::size_t> cells_to_halve(std::size_t begin, DisjointSets& lasting);
  // Unites a cell with what is not blocked at its faces, of its size or larger, and where places
  // may be on these. Mixed cells from one on are left out.
  void unite_neighbours(std::size_t cell, std::size_t mixed_from, DisjointSets& sets) const;
  // Gives those of the mixed cells a sphere of their own that can have one.
  void find_own_spheres(const std::vector<std::size_t>& mixed);
  OwnSphere own_sphere(const Entry& cell) const;  // of radius 0 if there is none
  // The element of the coarse free cell that holds the centre of a sphere, or of the outside; none
  // if there is no such cell, or the sphere cannot be free. Cells of `level` and coarser are known.
  std::optional<std::uint32_t> free_cell_around(int level, const Sphere& wanted) const;
  // About the centre of a cell, or its own.
  Sphere sphere_of(const Entry& cell) const {
    return cell.state == State::kOwnSphere ? own_spheres_[cell.index].sphere
                                           : Sphere{center(cell), cell.clearance};
  }
  // Whether a point of clearance >= rho may lie on the common face of two cells.
  bool may_share_places(const Entry& a, const Entry& b) const;
  // Throws TooManyCells for those that so many of a level are halved into, or those of the finest
  // that are foreseen.
  void check_memory(int level, std::size_t halved) const;
  void classify(Entry& cell, const Eigen::Vector3d& middle, const SurfaceDistance& d) const;
  // From the centre to a corner, or a face, and all that rounding adds.
  double half_diagonal(int level) const;
  double half_edge(int level) const { return 0.5 * edge(level) * (1.0 + 1e-9) + rounding(); }
  // The cell of `level` or coarser that holds the index and is not refined; cells_.size() if that
  // one is refined further.
  std::size_t locate(int level, const Index& index) const;
  // Whether the sphere of a reached node lies in that of a reached neighbour, of its size or
  // coarser.
  bool lies_in_neighbour(const Entry& node) const;
  // The same answer as from LocalDiameter::on_segment(), between the centres of two nodes.
  double needed_between(const Entry& a, const Entry& b) const;
  // Whether the sphere provably passes between two open cells that share a face; `face` is the
  // centre of that.
  bool passes(const Entry& a, const Entry& b, const Eigen::Vector3d& face) const;
  // Calls visit(cell, index) for the face neighbours of the same size or coarser, and
  // visit(cells_.size(), index) for each face on the boundary of the cube.
  template <typename Visit>
  void for_each_face_neighbour(int level, const Index& index, Visit visit) const;
  // The same between the centres of their spheres, by bisection, or without it.
  bool passes_between_centers(const Entry& a, const Entry& b, int bisections) const;
  // Two open cells.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  // Unites an open cell with the open ones at its faces to which the sphere passes by passes(), and
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
  SphereDisplacement displacement_;
  const LocalDiameter& diameter_;
  Shape shape_;
  std::array<double, kMostLevels + 1> edges_{};  // of the cells of each level
  double rounding_ = 0.0;
  int levels_;  // with the halvings of zones
  std::vector<Entry> cells_;
  std::vector<OwnSphere> own_spheres_;
  std::atomic<double> widest_bounds_ = 0.0;  // of distances: upper less lower
  // Of the outside, 0, and each cell, one further: between which the sphere passes.
  DisjointSets sets_{1};
  std::vector<Pair> uncertain_;
};

template <typename Visit>
void FloodGrid::for_each_face_neighbour(int level, const Index& index, Visit visit) const {
  const std::uint32_t last = (std::uint32_t{1} << level) - 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool up : {false, true}) {
      if (index[axis] == (up ? last : 0U)) {
        visit(cells_.size(), index);
        continue;
      }
      Index neighbour = index;
      neighbour[axis] = up ? index[axis] + 1 : index[axis] - 1;
      const std::size_t found = locate(level, neighbour);
      if (found < cells_.size()) visit(found, neighbour);
    }
  }
}

}  // namespace spherule::internal
