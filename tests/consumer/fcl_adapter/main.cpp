// SPDX-License-Identifier: BSD-3-Clause
#include <fcl/geometry/bvh/BVH_model.h>

#include <iostream>
#include <spherule/adapters/fcl/collide.h>

namespace api = spherule::fcl_api;

// A cube of FCL's, covered, against itself: apart, then moved into each other.
int main() {
  fcl::BVHModel<fcl::OBBRSSd> cube;
  cube.beginModel();
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      fcl::Vector3d corner[4];
      for (int k = 0; k < 4; ++k) {
        corner[k][axis] = 100.0 * side;
        corner[k][(axis + 1) % 3] = k & 1 ? 100.0 : 0.0;
        corner[k][(axis + 2) % 3] = k & 2 ? 100.0 : 0.0;
      }
      cube.addTriangle(corner[0], corner[1], corner[2]);
      cube.addTriangle(corner[1], corner[3], corner[2]);
    }
  }
  cube.endModel();
  const auto geometry = api::sphere_model(cube, {.fit = {.max_error = 10.0, .effort = 0}});

  api::CollisionObjectd first(geometry), second(geometry);
  api::CollisionResultd result;
  second.setTranslation({0.0, 130.0, 0.0});
  const bool apart = api::collide(&first, &second, api::CollisionRequestd(), result) == 0;
  second.setTranslation({0.0, 99.0, 0.0});
  const bool touching = api::collide(&first, &second, api::CollisionRequestd(), result) == 1;
  std::cout << geometry->part().spheres->spheres().size() << " spheres\n";
  return apart && touching ? 0 : 1;
}
