// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/stage1/flood_grid.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace spherule::internal {

// A cubic cell of the flood, and which spheres and grid step are required there. A *place* is a
// point from which the surface is at least rho + padding away.
struct PlaceCell {
  BoxCell box;             // a cube
  double rho;              // no more than any point of the cell requires
  double step;             // of the grid there: shorter than an edge of the cell
  double surface_at_most;  // upper bound of the distance of the surface from the centre
};

// One large sphere instead of the finest cells of a cell beside a surface that is flat or convex.
// It touches the surface, up to the height of the scallops between the spheres of finest cells,
// step^2 / (4 rho), and at half a diagonal of a face from there, in four directions, the surface is
// no further from it than that.
struct SphereOfPlaces {
  Sphere sphere;
  Eigen::Vector3d foot;    // the point of the surface nearest to the centre of the cell
  Eigen::Vector3d normal;  // from there to the centre
};

// A sphere that would hold the places of a cell if it were free of the mesh grown by the padding.
// Empty where the cell is not suitable.
std::optional<SphereOfPlaces> wanted_sphere(const MeshDistance& distance, double padding,
                                            const PlaceCell& cell);

// What is left of a wanted sphere: free of the mesh grown by the padding, and it holds every place
// of the cell. For a point q of the surface the cell is proved to lie in the union of the sphere
// and the ball of radius rho + padding around q, and there is no place in that ball's interior.
// Empty where there is no such sphere, or to find out would take long.
std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell, const SphereOfPlaces& wanted);

// Halves leaves of a flood until none is lost: until each leaf that the sphere of radius
// (1 + share) rho may get to is reached or held. What this proves stands in flood_refinement.cpp.
class FloodGrid::Refinement {
 public:
  Refinement(FloodGrid& grid, ZoneBorders borders);

  // Takes all leaves into account for a share, from now on.
  void begin(double share);

  // The open leaves that are neither reached nor held, in order. More may be named so, never fewer.
  // What is not open never will be, and is not possible from now on.
  const std::vector<std::size_t>& lost();

  // After lost(): halves those of the leaves that are lost that lie at the front of what is
  // reached, and the possible ones around them, and floods on. Where the way to them follows the
  // border of a zone, the leaves are halved first at which that way begins. False if none can be
  // halved.
  bool refine();

 private:
  // Where in a leaf near a border of zones the larger sphere has room.
  enum class Room : std::uint8_t { kFarFromBorders, kNone, kPerhaps, kEverywhere };
  // In lost(): the leaves through which ways are followed from sources. On a border, in short: one
  // that is held, or reached and no source.
  enum class Way : std::uint8_t { kNone, kUncertain, kOnBorder };

  const std::vector<Entry>& cells() const { return grid_.cells_; }
  // Whether halving goes on and on because of a border of a zone.
  bool shows_no_end() const;
  bool can_be_halved(const Entry& cell) const;
  // That halving makes: a leaf with a sphere of its own is halved until its cells are finest.
  std::size_t most_cells_within(const Entry& cell) const;
  bool is_at_boundary(const Entry& cell) const;

  bool is_possible(const Entry& cell) const;
  // Whether the clearance may be (1 + share) rho somewhere in a leaf, up to the roundings.
  bool may_have_room(const Entry& cell, double rho) const;
  // Whether the cell lies as a whole in the sphere of a leaf that touches it and counts.
  template <typename Counts>
  bool is_held_by(std::size_t cell, Counts counts) const;
  // Classifies the cells from one on. Drops the uncertain leaves that are none any more, and adds
  // those of the new cells, and of some others, that are possible and not held.
  void uncertain_from(std::size_t begin, const std::vector<std::size_t>& others);

  // Whether ways begin at a leaf: reached, and not near a border where that matters.
  bool is_source(std::size_t cell) const;
  // Whether a leaf ends the cube, or shares a face with a source.
  bool touches_source(std::size_t cell) const;

  // Of flood_borders.cpp, where borders of zones are followed.
  struct Border {
    Room room = Room::kFarFromBorders;
    double rho = std::numeric_limits<double>::infinity();  // the least, if there may be less room
  };
  Border border(const Entry& cell) const;
  // Of a leaf that is not uncertain: whether the larger sphere may be in it and it is no source.
  bool is_on_border(std::size_t cell) const;
  // Whether it is worth the cells to halve a leaf on a border.
  bool is_coarse(const Entry& cell) const;
  // Whether a leaf on a border has a source at a face that requires no more room: then the border
  // is not in its way.
  bool is_entered_from_within(std::size_t cell) const;
  // Opens what ways lead to that begin at these, and finds what is to be halved.
  void follow_borders(const std::vector<std::size_t>& first);
  // Finds the leaves at which ways end (is_end) and from which there is a way along borders to
  // leaves that are lost. Returns the lost leaves that have a leaf on a border at a face.
  std::vector<std::size_t> find_entries(const std::vector<char>& is_end);
  // Opens what ways lead to from `waiting`, and returns the leaves that are opened and not left, as
  // ways end there.
  std::vector<std::size_t> open_ways(std::vector<std::size_t> waiting,
                                     const std::vector<char>& is_end);

  // Calls visit(leaf) for the leaves that are lost from the reached ones on, up to where there is
  // room: what is behind a free leaf matters once that is reached, and needs no finer cells until
  // then.
  template <typename Visit>
  void for_each_at_the_front(Visit visit) const;
  // Connects new cells with finer ones at their faces that were there before.
  void connect_finer(std::size_t begin) const;
  // Calls visit(leaf) for the leaves that share a point with a cell, or a face (not an edge or a
  // corner alone). Not for itself.
  template <typename Visit>
  void for_each_touching(std::size_t cell, bool by_faces, Visit visit) const;

  FloodGrid& grid_;
  bool follows_borders_;
  std::size_t made_;  // cells, as the grid was made
  std::size_t most_cells_;
  double share_ = 0.0;
  int rounds_ = 0;                      // of halving
  std::vector<char> is_possible_;       // of each cell
  std::vector<Border> border_;          // the same, where borders are followed
  std::vector<std::size_t> uncertain_;  // possible and not held, in order
  // The uncertain leaves from which on cells are halved; may name one twice, or one that is not
  // open.
  std::vector<std::size_t> front_;
  std::vector<std::size_t> entries_;  // on borders, to be halved before these
  // Of each cell, in lost().
  std::vector<Way> way_;
  std::vector<char> is_open_;
};

template <typename Visit>
void FloodGrid::Refinement::for_each_touching(std::size_t cell, bool by_faces, Visit visit) const {
  const Entry& self = cells()[cell];
  const Index index = decode(self.code);
  // In units of the finest cells that there can be.
  std::array<std::uint32_t, 3> low{};
  const std::uint32_t size = std::uint32_t{1} << (kMostLevels - self.level);
  for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = index[axis] * size;
  const auto descend = [&](const auto& descend_on, std::size_t node, const Index& node_low,
                           std::uint32_t node_size) -> void {
    int apart_by_none = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t begin = std::max(low[axis], node_low[axis]);
      const std::uint32_t end = std::min(low[axis] + size, node_low[axis] + node_size);
      apart_by_none += begin == end ? 1 : 0;
    }
    if (by_faces && apart_by_none > 1) return;
    if (cells()[node].state != State::kRefined) {
      if (node != cell) visit(node);
      return;
    }
    const std::uint32_t half = node_size / 2;
    // The halves along each axis that the cell touches.
    std::array<std::array<bool, 2>, 3> touches{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      touches[axis] = {low[axis] <= node_low[axis] + half,
                       low[axis] + size >= node_low[axis] + half};
    }
    for (std::uint32_t k = 0; k < 8; ++k) {
      if (!touches[0][k & 1U] || !touches[1][k >> 1 & 1U] || !touches[2][k >> 2 & 1U]) continue;
      const Index child_low = {node_low[0] + (k & 1U) * half, node_low[1] + (k >> 1 & 1U) * half,
                               node_low[2] + (k >> 2 & 1U) * half};
      descend_on(descend_on, cells()[node].index + k, child_low, half);
    }
  };
  descend(descend, 0, {0, 0, 0}, std::uint32_t{1} << kMostLevels);
}

}  // namespace spherule::internal
