// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/pose.h"
#include "spheretree/triangle_mesh.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <memory>
#include <vector>

namespace spherule::test {

// A mesh as FCL sees it, with what FCL lacks: its bounding volume hierarchies are surfaces, so that
// one closed mesh wholly inside another is "free" to FCL. Here a mesh is its triangles with their
// inside (points of winding number other than zero; none if the mesh is not closed).
class FclMesh {
 public:
  explicit FclMesh(const TriangleMesh& mesh);
  FclMesh(FclMesh&&) noexcept;
  FclMesh& operator=(FclMesh&&) noexcept;
  ~FclMesh();

  const Eigen::AlignedBox3d& box() const { return box_; }
  bool closed() const { return closed_; }
  std::size_t triangle_count() const { return mesh_.triangles.size(); }
  // By the winding number, a sum over all triangles.
  bool contains(const Eigen::Vector3d& point) const;

  // Whether the two have a point in common.
  friend bool touch(const FclMesh& a, const Pose& world_from_a, const FclMesh& b,
                    const Pose& world_from_b);
  // Distance between the two surfaces. That is the distance of the meshes unless they touch.
  friend double surface_distance(const FclMesh& a, const Pose& world_from_a, const FclMesh& b,
                                 const Pose& world_from_b);

 private:
  struct Model;  // keeps FCL's headers out of the tests

  bool contains_a_component_of(const FclMesh& other,
                               const Eigen::Isometry3d& this_from_other) const;

  TriangleMesh mesh_;
  Eigen::AlignedBox3d box_;
  bool closed_ = false;
  // A few vertices of each connected component; the first alone decides whether it is inside, the
  // others rule it out quickly.
  std::vector<std::vector<Eigen::Vector3d>> components_;
  std::unique_ptr<Model> model_;
};

}  // namespace spherule::test
