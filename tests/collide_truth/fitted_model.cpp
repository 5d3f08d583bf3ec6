// SPDX-License-Identifier: BSD-3-Clause
#include "tests/collide_truth/fitted_model.h"

#include "base/rounding.h"
#include "io/mesh_io.h"
#include "simplifier/simplify.h"
#include "spheretree/build.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/shapes.h"
#include "tests/support/zoo.h"

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>

namespace spherule::test {
namespace {

const FittedModel& cached(const std::string& name, const std::function<TriangleMesh()>& make) {
  static std::map<std::string, FittedModel> models;
  const auto found = models.find(name);
  if (found != models.end()) return found->second;
  return models.emplace(name, fit_model(name, make())).first->second;
}

}  // namespace

TriangleMesh shape_mesh(const std::string& name) {
  const std::map<std::string, std::function<TriangleMesh()>> makers = {
      {"cube", [] { return make_cube(100); }},
      // Small enough to find leaks between the spheres of a large model.
      {"probe", [] { return make_cube(0.5); }},
      {"slab",
       [] {
         return make_box({200, 120, 10});
       }},
      {"sphere", [] { return make_sphere(60, 32, 16); }},
      {"torus", [] { return make_torus(80, 20, 48, 24); }},
      {"cylinder", [] { return make_cylinder(30, 160, 48); }},
      {"cone", [] { return make_cone(50, 120, 48); }},
      {"pipe", [] { return make_pipe(40, 34, 150, 48); }},
      {"bracket", [] { return make_l_bracket(100, 60, 12); }},
      {"plate",
       [] {
         return make_plate_with_holes({160, 120, 12}, 3, 2, 30, 24);
       }},
      {"open-box",
       [] { return moved(open_box(), Eigen::Isometry3d(Eigen::Translation3d(-0.5, -0.5, -0.5))); }},
      {"shells", [] { return nested_shells(3); }},
      {"soup", [] { return soup(40, 7); }}};
  TriangleMesh mesh = makers.at(name)();
  if (name == "open-box" || name == "shells" || name == "soup") {
    for (Eigen::Vector3d& v : mesh.vertices) v *= 120.0;  // these are made at unit size
  }
  return mesh;
}

FittedModel fit_model(const std::string& name, const TriangleMesh& mesh, double error_share,
                      double radius_factor) {
  FclSolid fcl_mesh(mesh);
  const Eigen::AlignedBox3d box = fcl_mesh.box();
  const double error = (test::kSanitized ? 2.0 : 1.0) * error_share * box.diagonal().norm();
  SimplifyOptions options;
  options.max_error = error;
  options.min_external_diameter = 4.0 * error;
  options.effort = test::effort(1, 0);
  const Simplification fit = simplify(mesh, options);
  const std::string broken = broken_promises(fit);
  if (!broken.empty()) throw std::runtime_error(name + ": " + broken);
  if (!fit.certificate.protrusion_over_mesh) {
    throw std::runtime_error(name + ": protrusion over the mesh is not known");
  }
  std::vector<Sphere> spheres = fit.cover.spheres;
  for (Sphere& s : spheres) s.radius *= radius_factor;
  double radius = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    radius = std::max(radius, distance_upper(v, box.center()));
  }
  return {name,
          mesh,
          std::move(fcl_mesh),
          build_tree(spheres),
          box.center(),
          radius,
          error,
          fit.certificate.protrusion_over_mesh->upper};
}

const FittedModel& shape_model(const std::string& name) {
  return cached(name, [&] { return shape_mesh(name); });
}

const FittedModel& real_model(const std::string& file, double millimetres) {
  return cached(file, [&] { return read_mesh(*models_dir() / file, {.scale = millimetres}); });
}

}  // namespace spherule::test
