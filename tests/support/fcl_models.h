// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "tests/support/mesh_facts.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <memory>
#include <vector>

namespace spherule {

template <class S>
fcl::Transform3<S> fcl_pose(const Pose& pose) {
  fcl::Transform3<S> result = fcl::Transform3<S>::Identity();
  result.linear() = pose.matrix().cast<S>();
  result.translation() = pose.translation().cast<S>();
  return result;
}

// A mesh as FCL's hierarchy of `Volume`, and its box for a test in front.
template <class Volume>
struct FclModel {
  using S = typename Volume::S;

  explicit FclModel(const TriangleMesh& mesh)
      : geometry(std::make_shared<fcl::BVHModel<Volume>>()),
        box(bounding_box(mesh).template cast<S>()) {
    std::vector<fcl::Vector3<S>> vertices;
    for (const Eigen::Vector3d& vertex : mesh.vertices) vertices.push_back(vertex.cast<S>());
    std::vector<fcl::Triangle> triangles;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                             static_cast<std::size_t>(t[2]));
    }
    geometry->beginModel();
    geometry->addSubModel(vertices, triangles);
    geometry->endModel();
    geometry->computeLocalAABB();
  }

  // The smallest box along the world's axes around the turned box.
  Eigen::AlignedBox<S, 3> world_box(const fcl::Transform3<S>& pose) const {
    const Eigen::Matrix<S, 3, 1> center = pose * box.center();
    const Eigen::Matrix<S, 3, 1> half = pose.linear().cwiseAbs() * (S(0.5) * box.sizes());
    return {center - half, center + half};
  }

  std::shared_ptr<fcl::BVHModel<Volume>> geometry;
  Eigen::AlignedBox<S, 3> box;
};

}  // namespace spherule
