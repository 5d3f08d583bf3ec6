// SPDX-License-Identifier: BSD-3-Clause
#include "tests/adapters/fcl/models.h"

#include "adapters/fcl/collide.h"
#include "tests/support/effort.h"
#include "tests/support/shapes.h"

#include <map>
#include <stdexcept>
#include <utility>

namespace spherule::test {

TriangleMesh fcl_test_mesh(const std::string& name) {
  if (name == "cube") return make_cube(100);
  if (name == "probe") return make_cube(10);
  if (name == "bracket") return make_l_bracket(100, 60, 12);
  if (name == "cylinder") return make_cylinder(30, 160, 12);
  throw std::out_of_range(name);
}

double fcl_test_error(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  return (kSanitized ? 0.2 : 0.1) * box.diagonal().norm();
}

std::shared_ptr<fcl_api::SphereModeld> covered_model(const std::string& name,
                                                     bool confirm_on_triangles) {
  static std::map<std::pair<std::string, bool>, std::shared_ptr<fcl_api::SphereModeld>> models;
  auto& model = models[{name, confirm_on_triangles}];
  if (!model) {
    const TriangleMesh mesh = fcl_test_mesh(name);
    const fcl_api::ModelOptions options{.fit = {.max_error = fcl_test_error(mesh), .effort = 0},
                                        .confirm_on_triangles = confirm_on_triangles};
    model = std::make_shared<fcl_api::SphereModeld>(fcl_api::cover_part(mesh, options));
  }
  return model;
}

fcl::Transform3d random_transform(Random& random, double range) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.linear() = random.rotation().toRotationMatrix();
  transform.translation() = range * random.unit() * random.direction();
  return transform;
}

std::vector<TwoTransforms> transforms_near_contact(const FclSolid& a, const FclSolid& b, int lines,
                                                   Random& random) {
  constexpr int kHalvings = 12;
  const double range = 0.5 * (a.box().diagonal().norm() + b.box().diagonal().norm());
  std::vector<TwoTransforms> transforms;
  for (int line = 0; line < lines; ++line) {
    const fcl::Transform3d tf_a = random_transform(random, range);
    fcl::Transform3d tf_b = random_transform(random, 0.0);
    const Eigen::Vector3d way = 1.2 * range * random.direction();
    const auto judge = [&](double share) {
      tf_b.translation() = tf_a.translation() + share * way;
      transforms.push_back({tf_a, tf_b});
      return touch(a, fcl_api::from_fcl(tf_a), b, fcl_api::from_fcl(tf_b));
    };
    double near = 0.0, far = 1.0;
    judge(far);
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (near + far);
      (judge(middle) ? near : far) = middle;
    }
  }
  return transforms;
}

}  // namespace spherule::test
