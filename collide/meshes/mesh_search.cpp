// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_search.h"

#include "collide/meshes/packed_mesh.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/box_gap.h"
#include "collide/search/queries.h"
#include "collide/search/single_precision.h"

#include <algorithm>

namespace spherule::internal {
namespace {

// Of T (relative_pose.h), which bounds what S bounds in mesh_kernel_impl.h: a placed centre errs by
// 136 u T and one rounding to single; 25 v T for the tests; 2 v r for the radius and 8 v r for the
// factor; and c = 6 v T. What is found apart is so by more than c then, and the canonical test
// finds it apart, too: where the mesh's lanes are numbers, because of sphere_triangle.h, which
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

}  // namespace spherule::internal
