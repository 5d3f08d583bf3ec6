// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/clearance.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <functional>
#include <optional>

// What the searches and proofs over cells of space query about S; what they make of the answers is
// theirs.

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

}  // namespace spherule::internal
