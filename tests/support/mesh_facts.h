// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <vector>

namespace spherule {

// Whether every directed edge is met by as many in the other direction: the triangles bound a solid
// (a closed chain). A triangle with a repeated corner closes upon itself.
bool is_closed(const TriangleMesh& mesh);

// Positive where the triangles face outwards.
double signed_volume(const TriangleMesh& mesh);

Eigen::AlignedBox3d bounding_box(const TriangleMesh& mesh);

// One vertex of every connected component (triangles that share vertices by index).
std::vector<Eigen::Vector3d> component_points(const TriangleMesh& mesh);

// The connected components, each as a mesh of its own.
std::vector<TriangleMesh> components(const TriangleMesh& mesh);

// Winding number of the mesh about a point off its surface: a whole number, up to rounding, for a
// closed mesh (Van Oosterom and Strackee, 1983).
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace spherule
