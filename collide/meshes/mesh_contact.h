// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Confirmation on the triangles: sphere trees find where two meshes may touch, their triangles
// decide. What the spheres call free stays free; what they call a collision becomes as exact as the
// meshes.
//
// @code{.cpp}
// #include <spherule/collide/meshes/mesh_contact.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const std::vector<spherule::Sphere> around{{{0.25, 0.25, 0.25}, 1}};
// const auto cover = std::make_shared<const spherule::SphereTree>(spherule::build_tree(around));
// const spherule::CoveredMesh part(tetrahedron, cover);
// const auto beside = spherule::Pose::from_translation({1.5, 0, 0});
// assert(collides(*cover, {}, *cover, beside));  // the spheres touch,
// assert(!collides(part, {}, part, beside));     // the meshes do not
// @endcode

#include "collide/meshes/mesh_tree.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/search/query.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule {

namespace internal {
class PatchTrees;
}  // namespace internal

// A mesh and spheres that cover it, with the triangles shared out among the spheres. Immutable;
// threads may share it. The mesh is judged as stored, as by MeshTree.
//
// Inside. A closed surface, triangles in which every directed edge, by positions, is met by as many
// in the other direction, has an inside: the points about which its winding number is not zero. The
// surfaces examined are those of geometry/shells.h, each by itself: all triangles that are
// connected by shared edges, as they are turned; the parts of these that are connected where no
// more than two triangles meet, all turned alike; and what bounds one room where more meet. So a
// sealed hollow is inside, a double-sided part has the inside of one of its sides, and so have the
// rooms on both sides of a wall. A part with a boundary, or which cannot be turned alike, has no
// inside: what lies within such a one without touching it is free. So is what only several parts
// enclose that share no edges, as halves that are not welded do.
//
// Not to be queried once it was moved from.
class CoveredMesh {
 public:
  // Proves that the spheres cover every triangle, and throws Error, naming one, where that fails.
  // For containment they have to cover the inside as well, as covers of the simplifier do; that is
  // not checked: where they leave a hollow, a body in that hollow is free.
  // Throws Error too for a mesh that validate() refuses and if `cover` is missing.
  CoveredMesh(const TriangleMesh& mesh, std::shared_ptr<const SphereTree> cover);

  // What it was made of.
  const SphereTree& cover() const { return *cover_; }
  const MeshTree& mesh() const { return solid_.mesh(); }
  // The mesh with its inside, as stored: inflation() is 0.
  const SolidMesh& solid() const { return solid_; }
  // The triangles (indices into the mesh) that a sphere of cover().spheres() stands for, at least
  // in part, sorted. Every point of a triangle lies in a sphere under which the triangle is listed.
  std::span<const std::int32_t> triangles_under(std::int32_t sphere) const {
    const auto i = static_cast<std::size_t>(sphere);
    const auto first = static_cast<std::size_t>(first_[i]);
    return std::span(triangles_).subspan(first, static_cast<std::size_t>(first_[i + 1]) - first);
  }
  // Whether every triangle is of a closed surface.
  bool is_closed() const { return solid_.is_closed(); }

  // For queries.
  const internal::MeshInside& inside() const { return solid_.inside(); }
  const internal::PatchTrees& patches() const { return *patches_; }

 private:
  // Lists the triangles under each sphere.
  std::shared_ptr<const internal::PatchTrees> share_out();

  std::shared_ptr<const SphereTree> cover_;
  SolidMesh solid_;
  std::vector<std::int32_t> first_;  // of each sphere in triangles_, and the end
  std::vector<std::int32_t> triangles_;
  std::shared_ptr<const internal::PatchTrees> patches_;
};

// Whether two meshes have a point in common, of their triangles or of their insides.
//
// Never false if they have one in exact arithmetic under exactly the given poses, and the spheres
// cover the insides. Proof: let a triangle s of a and a triangle t of b share the point p. p lies
// in a sphere under which s is listed and in one under which t is; these two touch, so the
// traversal reaches the pair, and s and t are tested. If no triangles touch, each component lies
// wholly inside the other mesh or wholly outside; one point tells which, and if it is inside, it is
// in spheres of both, so that two of them touch.
// If it is true, the exact gap is some units in the last place of the scene: in our tests at most
// collision_slack() of the covers, and 1e-9 of the scene between needles;
// geometry/triangles.h says why. Equal for every tree over the same spheres, and for
// swapped arguments but where the gap is below that. Neither throws nor allocates, with the
// exception that collides() of sphere trees has.
bool collides(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
              const Pose& world_from_b) noexcept;

// The two parts of that answer, for other ways to find the spheres that touch: call the first for
// every pair of spheres that touch until it is true, and the second if it never was.
//
// Two triangles that touch, up to rounding. None only if no triangle under the one sphere touches,
// within both spheres, one under the other.
std::optional<TrianglePair> touching_triangles(const CoveredMesh& a, std::int32_t sphere_a,
                                               const Pose& world_from_a, const CoveredMesh& b,
                                               std::int32_t sphere_b,
                                               const Pose& world_from_b) noexcept;
inline bool triangles_touch(const CoveredMesh& a, std::int32_t sphere_a, const Pose& world_from_a,
                            const CoveredMesh& b, std::int32_t sphere_b,
                            const Pose& world_from_b) noexcept {
  return touching_triangles(a, sphere_a, world_from_a, b, sphere_b, world_from_b).has_value();
}
// Lower bound of the penetration depth of two triangles, in the unit of the meshes: if it is above
// zero they have a point in common, and still have one after any displacement of one of them that
// moves none of its points by more than that. Otherwise nothing is proved.
double contact_depth(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                     const Pose& world_from_b, const TrianglePair& triangles) noexcept;
// Lower bound of the penetration depth of a triangle and a sphere of a set: if it is above zero
// they have a point in common, and still have one after any displacement of one of them that moves
// none of its points by more than that. Otherwise nothing is proved.
double contact_depth(const CoveredMesh& a, std::int32_t triangle_a, const Pose& world_from_a,
                     const SphereTree& b, std::int32_t sphere_b, const Pose& world_from_b) noexcept;
// A triangle under a sphere, and that depth.
struct TriangleDepth {
  std::int32_t triangle = -1;
  double depth = -std::numeric_limits<double>::infinity();
};
// Of the triangles under `sphere_a`, the one whose enclosing sphere is centred nearest to the
// centre of `sphere_b`, with its contact_depth(); -1 if there is none.
TriangleDepth nearest_triangle(const CoveredMesh& a, std::int32_t sphere_a,
                               const Pose& world_from_a, const SphereTree& b, std::int32_t sphere_b,
                               const Pose& world_from_b) noexcept;
// Whether a component of one mesh lies inside the other, given that no triangles touch.
bool contains_component(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                        const Pose& world_from_b) noexcept;

}  // namespace spherule
