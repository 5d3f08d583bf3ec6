// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace spherule::test {

// The twelve triangles of a box, facing outwards.
TriangleMesh box_mesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
inline TriangleMesh cube_mesh(double side = 1.0) {
  return box_mesh(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(side));
}
// A sphere of radius 1 about the origin: the icosahedron, each triangle split in four `levels`
// times.
TriangleMesh icosphere(int levels);
// A ring about the z axis.
TriangleMesh torus(double radius, double tube_radius, int around, int across);
// Along the z axis from 0 to `length`, open through the middle.
TriangleMesh pipe(double outer_radius, double inner_radius, double length, int sides);
// Two arms of 1 x 0.2 along x and z, 0.5 wide.
TriangleMesh l_bracket();
// 1 x 1, `thickness` high.
TriangleMesh thin_sheet(double thickness);
// A cube without its lid.
TriangleMesh open_box();
// Triangles without any connection, in the unit cube.
TriangleMesh soup(int triangles, unsigned seed);
// `count` boxes inside each other, facing outwards and inwards in turn.
TriangleMesh nested_shells(int count);
// The projective plane, half an icosahedron: closed without boundary, not orientable.
TriangleMesh projective_plane();
// Three quarters of a plane that share one edge.
TriangleMesh three_fins();
// Triangles a thousand times as long as wide, on a closed spindle.
TriangleMesh needles(int sides);

TriangleMesh inverted(TriangleMesh mesh);
TriangleMesh with_duplicates(TriangleMesh mesh);  // every triangle twice
// With facets of two and one distinct corner, and a collinear one on an edge.
TriangleMesh with_degenerates(TriangleMesh mesh);
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3d& motion);

// All of the above once, by name, the quickest to fit and hardest to bear first.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};
std::vector<NamedMesh> mesh_zoo();
// Those that a test takes which fits each: under sanitizers the first few.
std::vector<NamedMesh> zoo_to_fit();
// Throws std::out_of_range for a name that is not there.
TriangleMesh mesh_named(const std::string& name);

}  // namespace spherule::test
