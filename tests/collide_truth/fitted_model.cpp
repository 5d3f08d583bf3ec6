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

// The search ends at this distance from the border. On the way it passes 2 mm and 0.1 mm; each
// halving judges one pose, so that poses at all of these distances are among the results.
constexpr double kNearest = 1e-3;
// Share of the poses that are random without a search.
constexpr double kRandomShare = 0.1;

Pose centered_pose(const FittedModel& model, const Eigen::Quaterniond& rotation,
                   const Eigen::Vector3d& center) {
  return Pose(rotation, center - rotation * model.center);
}

// On a random triangle.
Eigen::Vector3d surface_point(const TriangleMesh& mesh, Random& random) {
  const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  const double s = random.unit(), r = random.unit() * (1.0 - s);
  return corner(0) + s * (corner(1) - corner(0)) + r * (corner(2) - corner(0));
}

class Search {
 public:
  Search(const FittedModel& a, const FittedModel& b, std::vector<JudgedPose>& poses)
      : a_(a), b_(b), poses_(poses) {}

  bool judge(const Pose& world_from_a, const Pose& world_from_b) {
    const bool touching = touch(a_.mesh, world_from_a, b_.mesh, world_from_b);
    poses_.push_back({world_from_a, world_from_b, touching});
    return touching;
  }

  void random_pose(Random& random) {
    const Eigen::Vector3d offset =
        random.direction() * (a_.radius + b_.radius) * random.between(0.0, 1.1);
    judge(centered_pose(a_, random.rotation(), Eigen::Vector3d::Zero()),
          centered_pose(b_, random.rotation(), offset));
  }

  // Sets a point of b's surface on one of a's and halves the way from there to far outside.
  void bisect(Random& random) {
    const Pose world_from_a = centered_pose(a_, random.rotation(), 500.0 * random.direction());
    const Eigen::Quaterniond rotation = random.rotation();
    const Eigen::Vector3d start = world_from_a * surface_point(a_.triangles, random) -
                                  rotation * surface_point(b_.triangles, random);
    const Eigen::Vector3d direction = random.direction();
    const auto at = [&](double s) -> Pose { return Pose(rotation, start + s * direction); };
    double near = 0.0, far = 2.0 * (a_.radius + b_.radius) + 1.0;
    if (!judge(world_from_a, at(near))) return;
    while (far - near > kNearest) {
      const double middle = 0.5 * (near + far);
      (judge(world_from_a, at(middle)) ? near : far) = middle;
    }
  }

 private:
  const FittedModel& a_;
  const FittedModel& b_;
  std::vector<JudgedPose>& poses_;
};

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

std::vector<JudgedPose> judged_poses(const FittedModel& a, const FittedModel& b, std::size_t count,
                                     Random& random) {
  std::vector<JudgedPose> poses;
  Search search(a, b, poses);
  while (static_cast<double>(poses.size()) < kRandomShare * static_cast<double>(count)) {
    search.random_pose(random);
  }
  while (poses.size() < count) search.bisect(random);
  return poses;
}

}  // namespace spherule::test
