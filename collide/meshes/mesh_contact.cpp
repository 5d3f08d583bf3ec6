// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_contact.h"

#include "base/error.h"
#include "collide/meshes/listed_triangles.h"
#include "collide/meshes/mesh_inside.h"
#include "collide/meshes/patch_trees.h"
#include "collide/meshes/triangle_leaves.h"
#include "collide/search/box_gap.h"
#include "collide/search/nearest_first.h"
#include "collide/search/packed_tree.h"
#include "collide/search/traversal.h"
#include "geometry/triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace spherule {
namespace {

std::shared_ptr<const SphereTree> not_null(std::shared_ptr<const SphereTree> cover) {
  if (!cover) throw Error("cover", "there is none");
  return cover;
}

// Policy of the traversal: ends at the first two spheres whose triangles touch.
class FindTriangles {
 public:
  static constexpr bool kNeedsGaps = false;

  FindTriangles(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                const Pose& world_from_b, const internal::RelativePose& pose)
      : a_(a),
        b_(b),
        world_from_a_(world_from_a),
        world_from_b_(world_from_b),
        pose_(pose),
        spheres_(a.cover(), b.cover(), pose) {}

  bool afford(const internal::OpenedPair&, const auto&) const noexcept { return true; }
  bool leaves(internal::NodePair pair) noexcept {
    if (!spheres_.touches(pair)) return true;
    if (!triangles_) triangles_.emplace(a_, world_from_a_, b_, world_from_b_, pose_);
    found_ = triangles_
                 ->touching(a_.cover().sphere_index(pair.index(0)),
                            b_.cover().sphere_index(pair.index(1)))
                 .has_value();
    return !found_;
  }
  // After the traversal.
  bool found() const { return found_ || (triangles_ && triangles_->contained()); }

 private:
  const CoveredMesh& a_;
  const CoveredMesh& b_;
  const Pose& world_from_a_;
  const Pose& world_from_b_;
  const internal::RelativePose& pose_;
  internal::SphereLeaves spheres_;
  std::optional<internal::ListedTriangles> triangles_;  // once two spheres touch
  bool found_ = false;
};

}  // namespace

CoveredMesh::CoveredMesh(const TriangleMesh& mesh, std::shared_ptr<const SphereTree> cover)
    : cover_(not_null(std::move(cover))), solid_(mesh, 0.0), patches_(share_out()) {}

std::shared_ptr<const internal::PatchTrees> CoveredMesh::share_out() {
  const std::size_t spheres = cover_->spheres().size();
  const std::vector<internal::Patch> patches =
      internal::share_out(solid_.mesh(), cover_->spheres());
  first_.assign(spheres + 1, 0);
  for (const internal::Patch& patch : patches) {
    ++first_[static_cast<std::size_t>(patch.sphere) + 1];
    triangles_.push_back(patch.triangle);
  }
  for (std::size_t i = 0; i < spheres; ++i) first_[i + 1] += first_[i];
  return std::make_shared<const internal::PatchTrees>(patches, cover_->spheres());
}

bool collides(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
              const Pose& world_from_b) noexcept {
  if (internal::far_apart(a.cover(), world_from_a, b.cover(), world_from_b)) return false;
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  if (internal::boxes_apart(a.cover(), b.cover(), pose)) return false;
  FindTriangles query(a, world_from_a, b, world_from_b, pose);
  internal::traverse(a.cover(), b.cover(), pose, query);
  return query.found();
}

std::optional<TrianglePair> touching_triangles(const CoveredMesh& a, std::int32_t sphere_a,
                                               const Pose& world_from_a, const CoveredMesh& b,
                                               std::int32_t sphere_b,
                                               const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose)
      .touching(sphere_a, sphere_b);
}

double contact_depth(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                     const Pose& world_from_b, const TrianglePair& triangles) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose).depth(triangles);
}

double contact_depth(const CoveredMesh& a, std::int32_t triangle_a, const Pose& world_from_a,
                     const SphereTree& b, std::int32_t sphere_b,
                     const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(b, world_from_b, a.mesh().tree(), world_from_a);
  return internal::TriangleLeaves(b, a.mesh(), pose).depth(sphere_b, triangle_a);
}

TriangleDepth nearest_triangle(const CoveredMesh& a, std::int32_t sphere_a,
                               const Pose& world_from_a, const SphereTree& b, std::int32_t sphere_b,
                               const Pose& world_from_b) noexcept {
  const std::span<const Sphere> spheres = a.mesh().tree().spheres();
  const internal::RelativePose pose(b, world_from_b, a.mesh().tree(), world_from_a);
  const Eigen::Vector3d center =
      pose.b_from_a()(b.spheres()[static_cast<std::size_t>(sphere_b)].center);
  TriangleDepth result;
  double least = std::numeric_limits<double>::infinity();
  for (const std::int32_t triangle : a.triangles_under(sphere_a)) {
    const double square =
        (spheres[static_cast<std::size_t>(triangle)].center - center).squaredNorm();
    if (square >= least) continue;
    least = square;
    result.triangle = triangle;
  }
  if (result.triangle >= 0) {
    result.depth = internal::TriangleLeaves(b, a.mesh(), pose).depth(sphere_b, result.triangle);
  }
  return result;
}

bool contains_component(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                        const Pose& world_from_b) noexcept {
  const internal::RelativePose pose(a.cover(), world_from_a, b.cover(), world_from_b);
  return internal::ListedTriangles(a, world_from_a, b, world_from_b, pose).contained();
}

}  // namespace spherule

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Boxes of one sphere, seen from the other.
struct BoxChange {
  float rotation[3][3];
  float size[3][3];  // of its entries
  float shift[3];
  float pad;

  PatchBox image(const PatchBox& box) const {
    PatchBox result;
    for (int i = 0; i < 3; ++i) {
      result.center[i] = (rotation[i][0] * box.center[0] + rotation[i][1] * box.center[1]) +
                         (rotation[i][2] * box.center[2] + shift[i]);
      result.half[i] =
          (size[i][0] * box.half[0] + size[i][1] * box.half[1]) + (size[i][2] * box.half[2] + pad);
    }
    return result;
  }
};

BoxChange box_change(const FrameChange& frames, const Vector3d& shift, double image_pad,
                     double radii, double box_pad) {
  constexpr double kFloatUnderflow = 0x1p-120;
  BoxChange result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto entry = static_cast<float>(frames.r[3 * i + j]);
      result.rotation[i][j] = entry;
      result.size[i][j] = std::abs(entry);
    }
    result.shift[i] = static_cast<float>(shift[i]);
  }
  result.pad =
      rounded_up_to_single(image_pad + box_pad * (radii + shift.lpNorm<1>()) + kFloatUnderflow);
  return result;
}

Vector3d normal_of(const Triangle& t) {
  return (t[1] - t[0]).cross(t[2] - t[1]);
}

// The box of the mask whose centre is nearest to that of another, by the sum of its distances along
// the axes.
int nearest_of(unsigned mask, const PatchNode& node, const PatchBox& box) {
  int nearest = std::countr_zero(mask);
  float least = std::numeric_limits<float>::infinity();
  for (; mask != 0; mask &= mask - 1) {
    const int lane = std::countr_zero(mask);
    float distance = 0.0F;
    for (int k = 0; k < 3; ++k) distance += std::abs(node.center[k][lane] - box.center[k]);
    if (distance < least) {
      least = distance;
      nearest = lane;
    }
  }
  return nearest;
}

float size_of(const PatchBox& box) {
  return std::max(std::max(box.half[0], box.half[1]), box.half[2]);
}

}  // namespace

// The dual-tree search from the boxes around all patches of two spheres.
class ListedTriangles::BoxSearch {
 public:
  BoxSearch(const ListedTriangles& of, std::int32_t sphere_a, std::int32_t sphere_b) : of_(of) {
    const Sphere spheres[2] = {of.sides_[0].sphere(sphere_a), of.sides_[1].sphere(sphere_b)};
    const double radii = spheres[0].radius + spheres[1].radius;
    for (std::size_t i = 0; i < 2; ++i) {
      const Side& side = of.sides_[i];
      roots_[i] = &side.patches.root(i == 0 ? sphere_a : sphere_b);
      from_other_[i] =
          box_change(side.from_other, side.from_other(spheres[1 - i].center) - spheres[i].center,
                     of.image_pad_, radii, kBoxPad);
    }
  }

  std::optional<TrianglePair> run() {
    if (roots_[0]->node < 0 || roots_[1]->node < 0) return std::nullopt;
    const std::size_t first = size_of(roots_[0]->box) < size_of(roots_[1]->box) ? 1 : 0;
    push(first, roots_[first]->node, from_other_[first].image(roots_[1 - first]->box),
         roots_[1 - first]->node);
    while (top_ > 0) {
      const Task task = tasks_[--top_];
      const PatchNode& node = of_.sides_[task.side].patches.node(task.node);
      bool is_seen = false;
      unsigned mask = overlaps(node, task.box);
      // The nearest comes last, and so is opened first.
      const int nearest = mask == 0 ? 0 : nearest_of(mask, node, task.box);
      while (mask != 0) {
        const unsigned others = mask & ~(1U << nearest);
        const int lane = others != 0 ? std::countr_zero(others) : nearest;
        mask &= ~(1U << lane);
        const std::int32_t child = node.child[lane];
        if (child < 0 && task.other < 0) {
          if (!is_seen) see(task);
          is_seen = true;
          if (apart_from_seen(of_.sides_[task.side].mesh.mesh().triangle(~child))) continue;
          const TrianglePair pair = task.side == 0 ? TrianglePair{~child, ~task.other}
                                                   : TrianglePair{~task.other, ~child};
          if (touch(pair)) return pair;
          continue;
        }
        const PatchBox box = node.box(lane);
        if (task.other < 0 || (child >= 0 && size_of(box) >= size_of(task.box))) {
          push(task.side, child, task.box, task.other);
        } else {
          push(1 - task.side, task.other, from_other_[1 - task.side].image(box), child);
        }
      }
    }
    return std::nullopt;
  }

 private:
  // A node of one side to be opened against a box of the other, in the former's frame, with a node
  // or a triangle.
  struct Task {
    PatchBox box;
    std::size_t side;
    std::int32_t node;
    std::int32_t other;
  };

  void push(std::size_t side, std::int32_t node, const PatchBox& box, std::int32_t other) {
    assert(top_ < tasks_.size());
    tasks_[top_++] = {box, side, node, other};
  }

  // The triangle that a task is about, in the frame of its node.
  void see(const Task& task) {
    const Side& side = of_.sides_[task.side];
    const Triangle& corners = of_.sides_[1 - task.side].mesh.mesh().triangle(~task.other);
    for (std::size_t k = 0; k < 3; ++k) seen_[k] = side.from_other(corners[k]);
    seen_normal_ = normal_of(seen_);
  }

  // Whether one of the two planes keeps a triangle apart from that.
  bool apart_from_seen(const Triangle& t) const {
    return apart_along(seen_normal_, t) || apart_along(normal_of(t), t);
  }
  bool apart_along(const Vector3d& axis, const Triangle& t) const {
    return separates(axis, gap_along(axis, t, seen_), of_.image_pad_);
  }

  bool touch(const TrianglePair& pair) const {
    return triangle_contact(of_.sides_[0].placed(pair.a), of_.sides_[1].placed(pair.b),
                            of_.corner_pad_, of_.scene_size_) != TriangleContact::kApart;
  }

  const ListedTriangles& of_;
  const PatchTrees::Root* roots_[2];
  BoxChange from_other_[2];
  // Each step opens a node of a pair and leaves seven more at most; a level deeper each time.
  std::array<Task, 2 * PatchTrees::kMaxDepth*(PatchNode::kWidth - 1) + 1> tasks_;
  std::size_t top_ = 0;
  Triangle seen_;
  Vector3d seen_normal_;
};

ListedTriangles::ListedTriangles(const CoveredMesh& a, const Pose& world_from_a,
                                 const CoveredMesh& b, const Pose& world_from_b,
                                 const RelativePose& pose)
    : sides_{{a, a.patches(), world_from_a.matrix(),
              0.5 * (world_from_a.translation() - world_from_b.translation()), pose.a_from_b()},
             {b, b.patches(), world_from_b.matrix(),
              0.5 * (world_from_b.translation() - world_from_a.translation()), pose.b_from_a()}},
      scene_size_(pose.scene_size()),
      corner_pad_(pose.leaf_pad()),
      image_pad_(kImagePad * pose.scene_size() + kUnderflow) {}

Triangle ListedTriangles::Side::placed(std::int32_t triangle) const {
  const Triangle& corners = mesh.mesh().triangle(triangle);
  Triangle result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = rotation * corners[k] + shift;
  return result;
}

std::optional<TrianglePair> ListedTriangles::touching(std::int32_t sphere_a,
                                                      std::int32_t sphere_b) const {
  return BoxSearch(*this, sphere_a, sphere_b).run();
}

double ListedTriangles::depth(const TrianglePair& pair) const {
  return triangle_depth(sides_[0].placed(pair.a), sides_[1].placed(pair.b), scene_size_);
}

bool ListedTriangles::holds_a_component(const Side& side, const CoveredMesh& other) const {
  const MeshInside& inside = side.mesh.inside();
  if (!inside.has_inside()) return false;
  const std::span<const Vector3d> points = other.mesh().component_points();
  return std::any_of(points.begin(), points.end(), [&](const Vector3d& point) {
    return inside.contains(side.mesh.mesh(), side.from_other(point), image_pad_);
  });
}

bool ListedTriangles::contained() const {
  return holds_a_component(sides_[0], sides_[1].mesh) ||
         holds_a_component(sides_[1], sides_[0].mesh);
}

}  // namespace spherule::internal
