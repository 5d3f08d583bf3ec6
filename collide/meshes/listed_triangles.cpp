// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/listed_triangles.h"

#include "collide/search/single_precision.h"
#include "collide/solids/mesh_inside.h"
#include "mesh/geometry/separating_axis.h"
#include "spheretree/moved_from.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

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
      image_pad_(kImagePad * pose.scene_size() + kUnderflow) {
  for (const Side& side : sides_) {
    require_content(side.mesh.mesh().tree().node_count() > 0, "CoveredMesh");
  }
}

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
  const std::span<const Vector3d> points = other.inside().component_points();
  return std::any_of(points.begin(), points.end(), [&](const Vector3d& point) {
    return inside.contains(side.mesh.mesh(), side.from_other(point), image_pad_);
  });
}

bool ListedTriangles::contained() const {
  return holds_a_component(sides_[0], sides_[1].mesh) ||
         holds_a_component(sides_[1], sides_[0].mesh);
}

}  // namespace spherule::internal
