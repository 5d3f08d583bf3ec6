// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where a set of spheres touches a solid, and how deep.
//
// @code{.cpp}
// #include <spherule/collide/primitive.h>
// #include <spherule/collide/solid_contact.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 3}, 1}, {{0, 0, 0.75}, 1}};
// const auto floor = spherule::HalfSpace{};
// const std::optional<spherule::SolidContact> contact =
//     deepest_contact(spherule::build_tree(spheres), {}, floor, {});
// assert(contact && contact->sphere == 1);
// assert(contact->overlap_depth > 0.249 && contact->overlap_depth <= 0.25);
// @endcode

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
