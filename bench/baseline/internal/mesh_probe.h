// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/baseline/internal/solid_probe.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace spherule::internal {

// The solid inside of a mesh.
class MeshProbe final : public SolidProbe {
 public:
  // The mesh must have passed validate().
  explicit MeshProbe(const TriangleMesh& mesh);

  double clearance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const override {
    return distance_(point).closest;
  }

  // Whether the winding number is closer to another whole number than to zero: right for closed
  // meshes, inverted ones too, and a sensible guess for open ones. The number is that of
  // MeshDistance, with groups of triangles that are far away taken as one (Barill and others, "Fast
  // winding numbers for soups and clouds", 2018, its first-order term).
  bool is_inside(const Eigen::Vector3d& point) const;

 private:
  // The triangles [begin, end) in depth-first order; an inner node's left child is the next node.
  struct Node {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d area = Eigen::Vector3d::Zero();  // sum of the area vectors
    double reach = 0.0;                              // of the triangles from the centre
    std::int32_t right = -1;                         // negative for a leaf
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Corners {
    Eigen::Vector3d a, b, c;
  };

  void build(std::int32_t begin, std::int32_t end);
  double solid_angle_of(std::int32_t node, const Eigen::Vector3d& point) const;

  MeshDistance distance_;
  std::vector<Corners> corners_;
  std::vector<Node> nodes_;
};

}  // namespace spherule::internal
