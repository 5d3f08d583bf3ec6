// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// Space around a mesh as a sparse octree of closed cubes. Cubes that M, grown by the padding, may
// meet are halved down to the finest step; the others are known to be free of it. Of those, the
// ones that are connected with the space around the octree through faces of free cubes are outside
// of |M|, proved; the rest counts as inside. That is |M| without what lies near M, and pockets of
// the outside whose way in is so narrow that no free cubes lead through it.
//
// The cubes are exact: those of a grid with corners at origin + step * (whole numbers). They fill
// space without a gap; their centres and sizes as computed are off by rounding, for which the tests
// and the spheres have a margin.
class CellOctree {
 public:
  enum class State : std::uint8_t { kOutside, kInside, kSurface, kRefined };
  struct Cell {
    std::array<std::uint32_t, 3> index = {};  // among the cells of the level
    std::uint32_t first_child = 0;            // of eight consecutive ones, if refined
    std::uint8_t level = 0;
    State state = State::kOutside;
  };

  // A finest step below this share of the largest coordinate drowns in its rounding.
  static constexpr double kLeastStep = 0x1p-32;
  // A finest cell may hang at most so many halvings below the root.
  static constexpr int kMostLevels = 20;
  // 20 bytes each, a quarter more while they are sorted into inside and outside.
  static constexpr std::size_t kMaxCells = std::size_t{1} << 24;

  // Finest cells of edge `step`, so placed that the box of M grown by the padding stands in the
  // middle of the cells along every axis. The mesh must have passed validate(); its vertex_error is
  // added to the padding. Throws Error("step") if the step is out of range or makes more than
  // kMaxCells cells.
  CellOctree(const TriangleMesh& mesh, double step, double padding);

  // Half number `k` (0 to 7) of a cell, in its state.
  static Cell child(const Cell& parent, std::uint32_t k);

  // The root first, parents before their children.
  const std::vector<Cell>& cells() const { return cells_; }
  // Level of the finest cells; the root has level 0.
  int levels() const { return levels_; }
  double step() const { return step_; }
  double edge(int level) const;
  // As computed, off by a few units in the last place of the largest coordinate.
  Eigen::Vector3d center(const Cell& cell) const;
  // Radius of a sphere about the computed centre that contains the exact cube, and with the reserve
  // that SphereTree requires of the spheres of its eight halves: in exact arithmetic these touch it
  // from inside at the corners, so that an octree is a layered hierarchy but for rounding.
  double circumscribed(int level) const;
  // Whether the centre of a refined cell lies in a free cell that counts as inside.
  bool has_center_inside(const Cell& cell) const;

 private:
  void place(const TriangleMesh& mesh, double padding);
  [[noreturn]] void refuse_count() const;
  void refine(std::uint32_t cell, const std::vector<std::array<Eigen::Vector3d, 3>>& triangles,
              const std::vector<std::uint32_t>& near);
  // The cell of `level` or coarser that holds the index and is not refined; the refined one of that
  // level if it is.
  std::uint32_t locate(int level, const std::array<std::uint32_t, 3>& index) const;
  void flood();

  std::vector<Cell> cells_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double step_;
  double size_ = 0.0;     // of the box of M, the longest side
  double reach_ = 0.0;    // the padding, rounding included
  double largest_ = 0.0;  // bound of the coordinates
  int levels_ = 0;
};

// Edge of a cube whose circumscribed sphere, with its margins for rounding, is nowhere further than
// `max_error` from any point of the cube.
inline double edge_for_error(double max_error) {
  return max_error * (0.5773502691896257 * (1.0 - 0x1p-10));
}

inline void check_padding(double padding) {
  if (!(padding >= 0.0 && padding <= kMaxCoordinate)) {
    throw Error("padding", "must be finite and not negative");
  }
}

using Triangle = std::array<Eigen::Vector3d, 3>;

// Whether `axis`, whose components are taken as exact, provably separates the closed cube about the
// origin from points whose coordinates `corners` have each been rounded once. A scalar product errs
// by less than 4 u times the sum of its terms' magnitudes, that rounding included; 8 u covers the
// rounding of the sum itself, too.
inline bool separates(const Eigen::Vector3d& axis, const Triangle& corners, double half) {
  const Eigen::Vector3d magnitude = axis.cwiseAbs();
  const double reach = half * magnitude.sum() * kRelativeUp;
  bool above = true;
  bool below = true;
  for (const Eigen::Vector3d& corner : corners) {
    const double at = axis.dot(corner);
    const double error = 8.0 * kUnitRoundoff * magnitude.dot(corner.cwiseAbs()) + kUnderflow;
    above = above && at - error > reach;
    below = below && at + error < -reach;
  }
  return above || below;
}

// False only if the closed triangle, which may be degenerate, and the closed cube of half the edge
// `half` about `center` are disjoint in exact arithmetic; true without need only within rounding of
// touching. Separating axes of Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing" (2001). An
// axis that has been rounded is another axis, and a plane across it separates just as well, so that
// only the projections need a margin.
inline bool may_intersect(const Triangle& triangle, const Eigen::Vector3d& center, double half) {
  using Eigen::Vector3d;
  const Triangle at = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
  const Triangle edges = {at[1] - at[0], at[2] - at[1], at[0] - at[2]};
  for (int k = 0; k < 3; ++k) {
    if (separates(Vector3d::Unit(k), at, half)) return false;
  }
  if (separates(edges[0].cross(edges[1]), at, half)) return false;
  for (const Vector3d& edge : edges) {
    for (int k = 0; k < 3; ++k) {
      if (separates(Vector3d::Unit(k).cross(edge), at, half)) return false;
    }
  }
  return true;
}

}  // namespace spherule::internal
