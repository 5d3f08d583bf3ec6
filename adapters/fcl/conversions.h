// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Transforms and models of FCL as poses and meshes, and back.
//
// @code{.cpp}
// #include <spherule/adapters/fcl/conversions.h>
// #include <cassert>
//
// fcl::Transform3d shifted = fcl::Transform3d::Identity();
// shifted.translation() = fcl::Vector3d(1, 2, 3);
// const spherule::Pose pose = spherule::fcl_api::from_fcl(shifted);
// assert(pose.translation() == Eigen::Vector3d(1, 2, 3));
// assert(spherule::fcl_api::to_fcl(pose).isApprox(shifted));
// @endcode

#include "base/error.h"
#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"

#include <fcl/common/types.h>
#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

namespace spherule::fcl_api {

// The pose of a transform of either precision: the rotation nearest to its matrix, up to rounding,
// and its translation. What is queried of the pose is answered for that rotation, from which an
// entry of the matrix differs by at most 1e-6. Throws Error for numbers that are not finite, a
// matrix that is no rotation to within 1e-6 an entry (of R^T R), a reflection, and a translation
// beyond kMaxCoordinate.
template <class S>
Pose from_fcl(const fcl::Transform3<S>& world_from_body) {
  return Pose::from_isometry(world_from_body.template cast<double>());
}

// A pose as FCL has it, rounded to nearest: each entry of the matrix errs by kRotationEntryError,
// in single precision by 2^-24 more.
template <class S = double>
fcl::Transform3<S> to_fcl(const Pose& world_from_body) {
  return world_from_body.isometry().template cast<S>();
}

// The triangles of a model of any bounding volume and either precision, vertex by vertex as FCL
// stores them. Throws Error for a model that is not finished (endModel() comes last), holds points
// only, or that validate() refuses.
template <class BV>
TriangleMesh from_fcl(const fcl::BVHModel<BV>& model) {
  const std::string subject = "FCL model";
  if (model.build_state != fcl::BVH_BUILD_STATE_PROCESSED &&
      model.build_state != fcl::BVH_BUILD_STATE_UPDATED) {
    throw Error(subject, "it is not finished, endModel() has not been called");
  }
  if (model.getModelType() != fcl::BVH_MODEL_TRIANGLES) {
    throw Error(subject, "it has no triangles");
  }
  constexpr auto kNoVertex = static_cast<std::size_t>(std::numeric_limits<int>::max());
  TriangleMesh mesh;
  mesh.vertices.reserve(static_cast<std::size_t>(model.num_vertices));
  for (int i = 0; i < model.num_vertices; ++i) {
    mesh.vertices.push_back(model.vertices[i].template cast<double>());
  }
  mesh.triangles.reserve(static_cast<std::size_t>(model.num_tris));
  for (int i = 0; i < model.num_tris; ++i) {
    const fcl::Triangle& corners = model.tri_indices[i];
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      triangle[k] = static_cast<int>(std::min<std::size_t>(corners[k], kNoVertex));
    }
    mesh.triangles.push_back(triangle);
  }
  validate(mesh, subject);
  return mesh;
}

}  // namespace spherule::fcl_api
