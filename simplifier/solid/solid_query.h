// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What the searches and proofs over cells of space query about S; what they make of the answers is
// theirs.

#include "base/rounding.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace spherule::internal {

// A cell whose centre is outside of S is halved further than others, down to this share of what is
// the finest elsewhere, to see whether S is there at all: a sphere placed for it would protrude for
// nothing.
inline constexpr double kFinestOutside = 1.0 / 64.0;
// Where not even a point of S is found near such a cell, it is halved down to this share: external
// spheres that close S by a hair leave none, and the next point of S may be far.
inline constexpr double kFinestPinch = 0x1p-16;

// No cell smaller than this is examined: clearances there are mostly rounding (SphereHierarchy: 32
// u times the largest coordinate, for spheres within the box), and halving no longer makes cells
// smaller (BoxCell: 8 u).
double least_reach(const Eigen::AlignedBox3d& box);

// Where a cell lies. A cell of S may be neither wholly inside nor have its centre inside.
struct CellState {
  bool outside = false;             // no point of it is in S
  bool inside = false;              // all of it is in S
  bool center_inside = false;       // its centre is in S
  const Sphere* contact = nullptr;  // the external sphere nearest to its centre, as in ClearanceAt
};

// From the clearance at the centre of a cell of half diagonal `reach`.
inline CellState state_of(const ClearanceAt& at, double reach) {
  return {at.upper <= -reach, at.lower >= reach, at.lower >= 0.0, at.contact};
}

// As closely as it matters for a cell of this size.
CellState classify(const Clearance& clearance, const BoxCell& cell);

// A point of the mesh within the half diagonal of the cell's centre: S may be as thin as the mesh,
// which is in it. As computed, off the mesh by up to mesh_point_error().
std::optional<Eigen::Vector3d> mesh_point_in(const MeshDistance& distance, const BoxCell& cell);
double mesh_point_error(const MeshDistance& distance);

// A point of S at most `within` from the centre of the cell, which is outside of S; found by moving
// away from the contacts, so there may be one where none is returned.
std::optional<Eigen::Vector3d> solid_point_near(const Clearance& clearance, const BoxCell& cell,
                                                double within);
// The same from a point, also where external spheres meet at an acute angle: in steps from
// `first_step` on, which is positive. It takes some hundred clearances where there is none.
std::optional<Eigen::Vector3d> solid_point_in_groove(const Clearance& clearance,
                                                     const Eigen::Vector3d& start,
                                                     double first_step, double within);

// How a point of S is looked for that stands for a cell whose centre is outside of S.
struct SolidPointSearch {
  double finest;         // half diagonal of the finest cells elsewhere: the shares above are of it
  double within;         // how far from the centre of the cell a point of S may be, off the mesh
  bool grooves = false;  // whether smallest cells are searched where external spheres meet, too
};
struct SolidPoint {
  enum class Kind : char {
    kOnMesh,   // mesh_point_in()
    kInSolid,  // found by moving away from external spheres
    kPinch     // the centre of a cell too small to be halved, near which no point of S was found
  };
  Kind kind;
  Eigen::Vector3d point;
};
// None if the cell has to be halved. Points of the mesh for which `accepts` is false are passed
// over; none are where it is empty.
std::optional<SolidPoint> solid_point_for(
    const Clearance& clearance, const MeshDistance& distance, const BoxCell& cell,
    const SolidPointSearch& search,
    const std::function<bool(const Eigen::Vector3d&)>& accepts = {});

// No point of the cell that is not in the open sphere `excluded` is further from `point` than the
// result (G1), which is never above BoxCell::furthest().
//
// With d and e the vectors to the centre of the cell from `point` and from the centre of the
// sphere, R its radius and m any number that is not negative: for y with |e + y| >= R
//
//   |d + y|^2 <= |d + y|^2 + m (|e + y|^2 - R^2)
//              = |d|^2 + m (|e|^2 - R^2) + 2 (d + m e) . y + (1 + m) |y|^2,
//
// which is largest where each |y_i| is the half extent and has the sign of (d + m e)_i. For
// m = |d| / |e|, d + m e is zero where d and e are opposite: the excess is then, up to terms of
// higher order, at most (1 / |d| + 1 / |e|) |half|^2 / 2.
//
// Rounding: no term passes through more than 12 operations, so that the sum errs by less than 16 u
// times the sum of the sizes of all terms, of which 32 u are added. Squares that underflow lose
// less than (1 + m) 2^-1070 in all. If m > 0, |d| is at least 2^-537, and 32 u of m |e|^2, which is
// about |d| |e|, are more; if m = 0, kUnderflow is more than the root of that. Where subnormal
// numbers are zero, this holds for what rounding.h says of distances: 0 or at least 2^-460.
inline double furthest_outside(const BoxCell& cell, const Eigen::Vector3d& point,
                               const Sphere& excluded) {
  const double anywhere = cell.furthest(point);
  const Eigen::Vector3d d = cell.center - point;
  const Eigen::Vector3d e = cell.center - excluded.center;
  const double length = e.norm();
  if (length < kLeastNorm) return anywhere;
  const double m = d.norm() / length;
  const double squares = d.squaredNorm() + m * e.squaredNorm();
  const double removed = m * excluded.radius * excluded.radius;
  const double around = (1.0 + m) * cell.half.squaredNorm();
  const double slope = 2.0 * (d + m * e).cwiseAbs().dot(cell.half);
  const double sizes =
      squares + removed + around + 2.0 * (d.cwiseAbs() + m * e.cwiseAbs()).dot(cell.half);
  const double squared = (squares - removed) + slope + around + 32.0 * kUnitRoundoff * sizes;
  return std::min(anywhere, std::sqrt(std::max(squared, 0.0)) * kRelativeUp + kUnderflow);
}

}  // namespace spherule::internal
