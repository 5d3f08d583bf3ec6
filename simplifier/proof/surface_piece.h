// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/rounding.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace spherule::internal {

// A triangle, or a part of one.
struct SurfacePiece {
  std::array<Eigen::Vector3d, 3> corner;
};

struct FurthestCorner {
  Eigen::Vector3d corner;
  double distance;  // no point of the piece is further: a distance is convex
};

inline FurthestCorner furthest_corner(const SurfacePiece& piece, const Eigen::Vector3d& point) {
  FurthestCorner furthest{piece.corner[0], distance_upper(point, piece.corner[0])};
  for (std::size_t k = 1; k < 3; ++k) {
    const double distance = distance_upper(point, piece.corner[k]);
    if (distance > furthest.distance) furthest = {piece.corner[k], distance};
  }
  return furthest;
}

// The edge from this corner to the next is as long as any.
inline std::size_t longest_edge(const SurfacePiece& piece) {
  const auto& p = piece.corner;
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double l = (p[(k + 1) % 3] - p[k]).squaredNorm();
    if (l > length) {
      length = l;
      longest = k;
    }
  }
  return longest;
}

// Appends the halves of a piece, which is cut at the middle of its longest edge.
inline void halve(const SurfacePiece& piece, std::vector<SurfacePiece>& parts) {
  const std::size_t longest = longest_edge(piece);
  const auto& p = piece.corner;
  const Eigen::Vector3d& from = p[longest];
  const Eigen::Vector3d& to = p[(longest + 1) % 3];
  const Eigen::Vector3d& apex = p[(longest + 2) % 3];
  const Eigen::Vector3d middle = (from + to) / 2.0;
  parts.push_back({{from, middle, apex}});
  parts.push_back({{middle, to, apex}});
}

}  // namespace spherule::internal
