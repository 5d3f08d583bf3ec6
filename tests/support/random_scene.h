// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Seeded spheres, trees, poses and covered meshes, the same with every standard library.

#include "collide/meshes/mesh_contact.h"
#include "collide/search/instruction_set.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/random.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test {

// `count` spheres with centres in a cube of half side `size`.
std::vector<Sphere> random_spheres(Random& random, int count, double size, double largest_radius);

struct Family {
  std::string name;
  std::vector<Sphere> spheres;
};

// Families of spheres, usual and degenerate, of `count` spheres each. Deterministic in `seed`.
std::vector<Family> sphere_families(std::size_t count, std::uint64_t seed);

// Spheres and a number that no function takes: not a number, infinite, negative, too large.
std::vector<Sphere> unusable_spheres();

// A tree as deep as can be: every inner node has `branching` - 1 leaves and, but for the last, one
// inner node, which is its last child (or its first). All its spheres meet near the origin, so that
// a traversal of two of them prunes nothing.
SphereTree caterpillar(int depth, int branching, bool inner_first);

// Trees of one sphere.
SphereTree tree_of(const Sphere& sphere);
std::shared_ptr<const SphereTree> one_sphere_tree(const Eigen::Vector3d& center, double radius);

// Triangles without any connection: ordinary ones, needles where `width` is small.
TriangleMesh random_triangles(Random& random, int count, double size, double width);
std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh, std::size_t triangle);

// A closed tetrahedron, covered by one sphere a corner's cell and many more than it needs.
std::shared_ptr<const CoveredMesh> covered_tetrahedron(Random& random, double size);

// A mesh whose spheres are the spheres around its triangles.
std::shared_ptr<const CoveredMesh> covered_surface(const TriangleMesh& mesh);

// Its spheres, which keep it alive.
std::shared_ptr<const SphereTree> cover_of(const std::shared_ptr<const CoveredMesh>& mesh);

// Those that this machine has.
std::vector<InstructionSet> instruction_sets();

}  // namespace spherule::test
