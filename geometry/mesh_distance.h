// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Distances to the surface of a mesh, between proved bounds.

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace spherule {

// Proved bounds on the distance between a point and the mesh surface, and a point of the surface
// that is near.
struct SurfaceDistance {
  double lower = 0.0;
  double upper = std::numeric_limits<double>::infinity();
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();
  std::int32_t triangle = -1;
};

// Distance to the triangles of a mesh over a hierarchy of axis-aligned boxes. All guarantees of the
// simplifier rest on it, so every answer is an interval that contains the exact distance: the
// bounds of geometry/point_triangle.h for the triangles examined, and for the boxes that were
// skipped that they are no nearer than the answer. Usually upper - lower is below 1e-14 of the
// distance to the corners of the nearest triangle. Thread-safe after construction.
class MeshDistance {
 public:
  // Keeps a copy of the corners. The mesh must have passed validate() (geometry/triangle_mesh.h).
  explicit MeshDistance(const TriangleMesh& mesh);

  // Bounds of the distance from `point` to the surface. With a `limit`, only triangles nearer than
  // it are searched for; if there are none, `triangle` is -1, `lower` is the limit (or the proved
  // bound, a rounding below it) and `upper` infinite. Where triangles in more than `most_leaves`
  // leaves of the hierarchy (of a few each) would have to be examined, as about the centre of a
  // round shape, `lower` is 0 and `upper` that of those which were.
  SurfaceDistance operator()(
      const Eigen::Vector3d& point, double limit = std::numeric_limits<double>::infinity(),
      std::size_t most_leaves = std::numeric_limits<std::size_t>::max()) const;

  // Generalised winding number of the mesh about `point` (Van Oosterom and Strackee 1983): a whole
  // number up to rounding for a closed mesh, zero in the unbounded component of its complement.
  // Linear in the number of triangles.
  double winding_number(const Eigen::Vector3d& point) const;

  // A triangle as it is stored.
  struct Corners {
    Eigen::Vector3d a, b, c;
    std::int32_t triangle;  // its index in the mesh
  };

  // Calls visit(corners) for every triangle that the ray from `point` along `direction` intersects,
  // and for some that it misses, until a call returns false; returns whether none did. No component
  // of the direction may be 0.
  template <typename Visit>
  bool visit_ray(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, Visit visit) const;
  // Calls visit(corners) for every triangle.
  template <typename Visit>
  void visit_all(Visit visit) const {
    for (const Corners& t : corners_) visit(t);
  }

  // Box of the vertices that triangles use.
  const Eigen::AlignedBox3d& box() const { return box_; }
  // Of the mesh.
  std::size_t triangle_count() const { return corners_.size(); }

 private:
  // Not aligned, so that its layout does not depend on a program's settings of Eigen.
  using BoxCorners = Eigen::Array<double, 2, 3, Eigen::DontAlign>;
  // The boxes of two children side by side, a row each, so that both are examined at once. A child
  // is a node, or a leaf where it is negative: that of the index ~child.
  struct Node {
    BoxCorners low;
    BoxCorners high;
    std::array<std::int32_t, 2> children{};
  };
  // Holds the triangles [begin, end).
  struct Leaf {
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  // The tree is halved at every level, so it is at most 32 deep for 2^31 triangles, and a
  // depth-first search that holds one waiting sibling per level needs no more entries than that.
  static constexpr std::size_t kStackSize = 40;

  static bool may_intersect(const Eigen::Array3d& low_corner, const Eigen::Array3d& high_corner,
                            const Eigen::Vector3d& point, const Eigen::Vector3d& direction);
  // Appends what holds the triangles [begin, end); returns it as a child, with its box.
  std::pair<std::int32_t, Eigen::AlignedBox3d> build(std::int32_t begin, std::int32_t end);

  std::vector<Node> nodes_;  // in depth-first order
  std::vector<Leaf> leaves_;
  std::int32_t root_ = -1;  // as a child
  std::vector<Corners> corners_;
  Eigen::AlignedBox3d box_;
};

template <typename Visit>
bool MeshDistance::visit_ray(const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                             Visit visit) const {
  std::array<std::int32_t, kStackSize> stack;
  std::size_t size = 0;
  if (may_intersect(box_.min().array(), box_.max().array(), point, direction))
    stack[size++] = root_;
  while (size > 0) {
    const std::int32_t child = stack[--size];
    if (child < 0) {
      const Leaf& leaf = leaves_[static_cast<std::size_t>(~child)];
      for (auto i = leaf.begin; i < leaf.end; ++i) {
        if (!visit(corners_[static_cast<std::size_t>(i)])) return false;
      }
      continue;
    }
    const Node& node = nodes_[static_cast<std::size_t>(child)];
    for (const int k : {1, 0}) {
      if (may_intersect(node.low.row(k), node.high.row(k), point, direction)) {
        stack[size++] = node.children[static_cast<std::size_t>(k)];
      }
    }
  }
  return true;
}

}  // namespace spherule
