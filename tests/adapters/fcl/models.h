// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "adapters/fcl/collide.h"
#include "geometry/triangle_mesh.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"

#include <fcl/common/types.h>
#include <fcl/geometry/bvh/BVH_model.h>

#include <memory>
#include <string>
#include <vector>

namespace spherule::test {

// Plain solids of some 100 units, by name: cube, probe (a small cube), bracket, cylinder.
TriangleMesh fcl_test_mesh(const std::string& name);

// E that the tests choose for a mesh: a share of its diagonal.
double fcl_test_error(const TriangleMesh& mesh);

template <class BV>
std::shared_ptr<fcl::BVHModel<BV>> fcl_model(const TriangleMesh& mesh) {
  using S = typename BV::S;
  auto model = std::make_shared<fcl::BVHModel<BV>>();
  model->beginModel();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) {
      return fcl::Vector3<S>(mesh.vertices[static_cast<std::size_t>(t[k])].cast<S>());
    };
    model->addTriangle(corner(0), corner(1), corner(2));
  }
  model->endModel();
  return model;
}

// The model of a name with the error above, made once per process.
std::shared_ptr<fcl_api::SphereModeld> covered_model(const std::string& name,
                                                     bool confirm_on_triangles = false);

// A turn and a place that are drawn from all of them, the place within `range` of the origin.
fcl::Transform3d random_transform(Random& random, double range);

// Two transforms at random, and more on a line through them, halving the way between a placement
// where the two touch and one where they do not.
struct TwoTransforms {
  fcl::Transform3d a, b;
};
std::vector<TwoTransforms> transforms_near_contact(const FclSolid& a, const FclSolid& b, int lines,
                                                   Random& random);

}  // namespace spherule::test
