// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace spherule {

// Where a set of spheres touches a solid, and how deep.
struct SolidContact {
  std::int32_t sphere = -1;  // index into SphereTree::spheres()
  // At least this far the sphere has to be moved for the two to part, in exact arithmetic under
  // exactly the given poses, rounded downward: below zero where rounding alone may have made them
  // touch. In the unit of the tree.
  double overlap_depth = 0.0;
  // A point of both, up to rounding: the sphere's centre where it is in the solid, otherwise the
  // point of the solid that is nearest to it.
  Eigen::Vector3d world_point = Eigen::Vector3d::Zero();
};

}  // namespace spherule
