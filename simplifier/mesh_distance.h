// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/triangle_mesh.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <limits>
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
// simplifier rest on it, so every answer is an interval that contains the exact distance:
//   upper: the distance to a point of the nearest triangle found, plus the rounding of that point;
//   lower: for the direction u from the found point to the query p, a triangle lies in the
//   half-space
//          u.(p - x) >= min over its corners v of u.(p - v), so that minimum over |u| is a lower
//          bound of its distance whatever the quality of the found point (needles and degenerate
//          triangles included); boxes that are skipped are further than the answer.
// Usually upper - lower is below 1e-14 of the size of the model. Thread-safe after construction.
class MeshDistance {
 public:
  // Keeps a copy of the corners. The mesh must have passed validate().
  explicit MeshDistance(const TriangleMesh& mesh);

  // Bounds of the distance from `point` to the surface. With a `limit`, the search may stop as soon
  // as the distance is proved to exceed it: then `lower` >= limit and `triangle` is -1.
  SurfaceDistance operator()(const Eigen::Vector3d& point,
                             double limit = std::numeric_limits<double>::infinity()) const;

  // Generalised winding number of the mesh about `point` (Van Oosterom and Strackee 1983): a whole
  // number up to rounding for a closed mesh, zero in the unbounded component of its complement.
  double winding_number(const Eigen::Vector3d& point) const;

  const Eigen::AlignedBox3d& box() const { return box_; }
  std::size_t triangle_count() const { return corners_.size(); }

 private:
  struct Node {
    Eigen::Vector3d low, high;
    std::int32_t first = 0;   // inner node: left child, the right one follows its subtree
    std::int32_t second = 0;  // inner node: right child; leaf: end of its triangles
    bool leaf = false;
  };
  struct Corners {
    Eigen::Vector3d a, b, c;
    std::int32_t triangle;
  };

  std::int32_t build(std::int32_t begin, std::int32_t end);

  std::vector<Node> nodes_;
  std::vector<Corners> corners_;
  Eigen::AlignedBox3d box_;
  double magnitude_ = 0.0;  // largest absolute coordinate, scales the rounding of a found point
};

}  // namespace spherule
