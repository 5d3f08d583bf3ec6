// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// A vertex of the Voronoi diagram of some sites: the centre of a sphere that has four of them (or
// more) on its boundary and none inside.
struct VoronoiVertex {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double radius = 0.0;
  std::array<std::uint32_t, 4> sites{};  // ascending
};

// The vertices within the box of the sites, from the Delaunay tetrahedra (qhull, as the lower hull
// of the sites lifted to a paraboloid). Left out are those of tetrahedra so flat that their centre
// has few digits: its distances to the four sites agree to kVoronoiTolerance times the radius plus
// the rounding of the coordinates, or it is dropped. More than four sites on one sphere give
// several vertices in the same place, up to rounding. Empty for fewer than five sites and for sites
// in one plane. Sites that occur twice are one. Deterministic; sorted by `sites`.
std::vector<VoronoiVertex> voronoi_vertices(std::span<const Eigen::Vector3d> sites);

inline constexpr double kVoronoiTolerance = 1e-9;

}  // namespace spherule::internal
