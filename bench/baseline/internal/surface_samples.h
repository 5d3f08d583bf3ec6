// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// About `count` points spread evenly over the triangles, each of which gets its share by area, at
// random within it; at least `per_triangle` on each that has an area. Same points for equal input.
std::vector<Eigen::Vector3d> even_samples(const TriangleMesh& mesh, std::size_t count,
                                          std::size_t per_triangle, std::uint64_t seed);

// Of the mesh; 0 if all triangles are degenerate.
double total_area(const TriangleMesh& mesh);

// The corners of the triangles, once each, and points about as far apart as `count` even samples
// are on edges that are sharp (more than some 18 degrees), open, or shared by more than two. What
// only even samples cover sticks out there first.
std::vector<Eigen::Vector3d> edge_samples(const TriangleMesh& mesh, std::size_t count);

// Both: what a cover of the surface is made for. Throws Error for a mesh without area.
std::vector<Eigen::Vector3d> cover_samples(const TriangleMesh& mesh, std::size_t count,
                                           std::size_t per_triangle, std::uint64_t seed);

}  // namespace spherule::internal
