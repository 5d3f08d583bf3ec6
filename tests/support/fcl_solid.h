// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace spherule {

// Ground truth: a mesh as FCL sees it (OBBRSS, double), with what FCL lacks. Its bounding volume
// hierarchies are surfaces, so that one closed mesh wholly inside another is "free" to FCL. Here a
// mesh is its triangles with their inside (points about which the winding number of a connected
// component is not zero, so also sealed hollows; none if the mesh is not closed).
class FclSolid {
 public:
  explicit FclSolid(const TriangleMesh& mesh);
  FclSolid(FclSolid&&) noexcept;
  FclSolid& operator=(FclSolid&&) noexcept;
  ~FclSolid();

  const Eigen::AlignedBox3d& box() const;
  // By the winding numbers, sums over all triangles.
  bool contains(const Eigen::Vector3d& point) const;

  // Whether the two have a point in common: two triangles do, or a point of a connected component
  // of one is inside the other.
  friend bool touch(const FclSolid& a, const Pose& world_from_a, const FclSolid& b,
                    const Pose& world_from_b);
  // Distance between the two surfaces. That is the distance of the solids unless they touch.
  friend double surface_distance(const FclSolid& a, const Pose& world_from_a, const FclSolid& b,
                                 const Pose& world_from_b);

 private:
  struct Model;  // keeps FCL's headers out of what uses this

  bool contains_a_component_of(const FclSolid& other, const Pose& this_from_other) const;

  std::vector<TriangleMesh> components_;  // none if the mesh is not closed
  std::vector<Eigen::Vector3d> points_;   // one of each component
  std::unique_ptr<const Model> model_;
};

}  // namespace spherule
