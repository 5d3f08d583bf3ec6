// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_tree.h"

#include "collide/meshes/mesh_inside.h"
#include "collide/meshes/mesh_search.h"
#include "collide/meshes/packed_mesh.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/box_gap.h"
#include "collide/search/nearest_first.h"
#include "collide/search/packed_tree.h"
#include "collide/search/queries.h"
#include "collide/search/query.h"
#include "geometry/sphere.h"
#include "geometry/triangles.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace spherule {
namespace {

using Triangle = internal::Triangle;

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
  validate(mesh, "mesh");
  std::vector<Triangle> result;
  result.reserve(mesh.triangles.size());
  for (const Eigen::Vector3i& indices : mesh.triangles) result.push_back(corners_of(mesh, indices));
  return result;
}

SphereTree tree_of(const std::vector<Triangle>& triangles) {
  std::vector<Sphere> spheres;
  spheres.reserve(triangles.size());
  for (const Triangle& triangle : triangles) spheres.push_back(enclosing_sphere(triangle));
  return build_tree(spheres);
}

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh)
    : triangles_(triangles_of(mesh)),
      tree_(tree_of(triangles_)),
      component_points_(internal::component_points(mesh)),
      node_boxes_(std::make_shared<const internal::NodeBoxes>(*this)),
      packed_(std::make_shared<const internal::PackedMesh>(triangles_, tree_.spheres())) {}

bool collides(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
              const Pose& world_from_b) noexcept {
  return internal::collides_by(internal::best_mesh_kernel(), a, world_from_a, b, world_from_b);
}

bool within(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
            const Pose& world_from_b, double clearance) {
  require_clearance(clearance);
  return internal::collides_by(internal::best_mesh_kernel(), a, world_from_a, b, world_from_b,
                               clearance);
}

DistanceResult distance(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const DistanceRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  const internal::TriangleLeaves leaves(a, b, pose);
  const internal::PairSpace space(a, b.tree(), pose, leaves);
  return internal::NearestFirst(space, pose.gap_error(), request)
      .run(internal::NodePair(0, 0), pose.gap(a.sphere(0), b.tree().sphere(0)));
}

CollisionResult collide(const SphereTree& a, const Pose& world_from_a, const MeshTree& b,
                        const Pose& world_from_b, const CollisionRequest& request) {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::all_pairs(a, b.tree(), pose, internal::TriangleLeaves(a, b, pose), request);
}

bool intersects_triangle(const SphereTree& a, std::int32_t sphere, const Pose& world_from_a,
                         const MeshTree& b, std::int32_t triangle,
                         const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  return internal::TriangleLeaves(a, b, pose).touches(sphere, triangle);
}

}  // namespace spherule

namespace spherule::internal {
namespace {

// Of T (relative_pose.h), which bounds what S bounds in mesh_kernel_impl.h: a placed centre errs by
// 136 u T and one rounding to single; 25 v T for the tests; 2 v r for the radius and 8 v r for the
// factor; and c = 6 v T. What is found apart is so by more than c then, and the canonical test
// finds it apart, too: where the mesh's lanes are numbers, because of triangle_leaves.h, which
// requires 2 v S and a distance of 4 v S; where not, because the leaf's sphere is what is apart.
// 48 v T covers it, and the absolute term what underflows (packed_tree.h). A clearance is part of
// every radius and of T, rounded up once; the margin is that of the growth without it.
constexpr double kInflation = 48.0 * kFloatRoundoff;
constexpr double kAbsolute = 0x1p-60;
static_assert(MeshNode::kWidth == 8);

struct Question {
  const SphereTree& a;
  const MeshTree& b;
  const RelativePose& pose;
  double clearance;

  static bool confirm(void* context, std::int32_t sphere, std::int32_t triangle) {
    const Question& in = *static_cast<const Question*>(context);
    return TriangleLeaves(in.a, in.b, in.pose, in.clearance).touches(sphere, triangle);
  }
};

}  // namespace

MeshKernel mesh_kernel_for([[maybe_unused]] InstructionSet set) {
#if defined(SPHERULE_X86_KERNELS)
  if (set == InstructionSet::kAvx512) return avx512_mesh_kernel();
  if (set == InstructionSet::kAvx2) return avx2_mesh_kernel();
#endif
  return portable_mesh_kernel();
}

MeshKernel best_mesh_kernel() {
  static const MeshKernel kKernel = mesh_kernel_for(best_instruction_set());
  return kKernel;
}

bool collides_by(MeshKernel kernel, const SphereTree& a, const Pose& world_from_a,
                 const MeshTree& b, const Pose& world_from_b, double clearance) noexcept {
  if (far_apart(a, world_from_a, b.tree(), world_from_b, clearance)) return false;
  const RelativePose pose(a, world_from_a, b.tree(), world_from_b);
  if (boxes_apart(a, b.tree(), pose, clearance)) return false;
  const PackedMesh& mesh = b.packed();
  if (a.branching() > MeshNode::kWidth || a.depth() + mesh.depth() > MeshTasks::kLevels) {
    return any_pair_within(a, b.tree(), pose, TriangleLeaves(a, b, pose, clearance), clearance);
  }
  const SphereTreeData& data = a.data();
  const FrameChange to_mesh = pose.b_from_a();
  const double rounding = kInflation * (pose.node_size() + clearance) + kAbsolute;
  const float inflation = rounded_up_to_single(rounding + clearance);
  MeshSpheres spheres = {.x = data.x.data(),
                         .y = data.y.data(),
                         .z = data.z.data(),
                         .radius = data.radius.data(),
                         .first_child = data.first_child.data(),
                         .child_count = data.child_count.data(),
                         .node_count = static_cast<std::int32_t>(a.node_count()),
                         .rotation = {},
                         .translation = {},
                         .inflation = inflation,
                         .root = {}};
  std::copy_n(to_mesh.r, 9, spheres.rotation);
  std::copy_n(to_mesh.t, 3, spheres.translation);
  const Eigen::Vector3d center = to_mesh(a.sphere(0).center);
  spheres.root = {
      static_cast<float>(center.x()),        static_cast<float>(center.y()),
      static_cast<float>(center.z()),        static_cast<float>(a.sphere(0).radius) + inflation,
      a.is_leaf(0) ? ~a.sphere_index(0) : 0, 0};
  MeshTasks tasks;  // 24 KiB that are not touched before they are needed
  Question question{a, b, pose, clearance};
  return kernel(mesh.view(), spheres, 3.0F * rounded_up_to_single(rounding), tasks,
                &Question::confirm, &question);
}

using Eigen::Vector3d;

bool are_apart(const Vector3d& p, const std::array<Vector3d, 3>& triangle, double reach) {
  const Vector3d a = triangle[0] - p, b = triangle[1] - p, c = triangle[2] - p;
  const auto nearest = [&](const Vector3d& axis) {
    return std::min({axis.dot(a), axis.dot(b), axis.dot(c)});
  };
  const Vector3d ab = triangle[1] - triangle[0];
  const Vector3d normal = ab.cross(triangle[2] - triangle[0]);
  const double low = nearest(normal);
  const double high = std::max({normal.dot(a), normal.dot(b), normal.dot(c)});
  if (separates(normal, std::max(low, -high), reach)) return true;

  const std::array<Vector3d, 3> corners = {a, b, c};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d edge = triangle[(i + 1) % 3] - triangle[i];
    const double square = edge.squaredNorm();
    if (square > 0.0) {
      const Vector3d foot = corners[i] - (corners[i].dot(edge) / square) * edge;
      if (separates(foot, nearest(foot), reach)) return true;
    }
    if (separates(corners[i], nearest(corners[i]), reach)) return true;
  }
  return false;
}

}  // namespace spherule::internal
