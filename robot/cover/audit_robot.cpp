// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/audit_robot.h"

#include "base/error.h"
#include "geometry/surface_sampling.h"
#include "geometry/triangle_mesh.h"
#include "robot/cover/link_parts.h"
#include "robot/model/kinematics.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::LinkParts;

constexpr std::size_t kSharePoints = 20000;

// Of points spread over the surface: one in every equal share of its area.
double uncovered_share(const LinkParts& part) {
  const TriangleMesh& mesh = *part.mesh;
  std::vector<double> area_up_to;
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    area += internal::area_of(corners_of(mesh, t));
    area_up_to.push_back(area);
  }
  std::size_t outside = 0;
  std::size_t triangle = 0;
  for (std::size_t i = 0; i < kSharePoints; ++i) {
    const double place = area * (static_cast<double>(i) + 0.5) / static_cast<double>(kSharePoints);
    while (triangle + 1 < area_up_to.size() && area_up_to[triangle] < place) ++triangle;
    const Vector3d point =
        internal::evenly_in(corners_of(mesh, mesh.triangles[triangle]), static_cast<double>(i));
    // The mesh may stand out of curved shapes by the chord error.
    const bool held = std::ranges::any_of(part.spheres, [&](const Sphere& sphere) {
      return (point - sphere.center).norm() <= sphere.radius + part.chord_error;
    });
    outside += held ? 0 : 1;
  }
  return static_cast<double>(outside) / static_cast<double>(kSharePoints);
}

double reach_of(const LinkParts& part) {
  double reach = 0.0;
  for (const Sphere& sphere : part.spheres) reach = std::max(reach, norm_upper(sphere.center));
  if (!part.mesh) return reach;
  for (const Vector3d& vertex : part.mesh->vertices) reach = std::max(reach, norm_upper(vertex));
  return reach;
}

// Of a point mapped by a computed pose: that of the pose (kinematics.h) and of the mapping, 40 u of
// the point's and the frame's distance (pose.h).
double map_error(double kinematics_error, double reach, const Pose& world_from_link) {
  return add_up(kinematics_error,
                48.0 * kUnitRoundoff * (reach + norm_upper(world_from_link.translation())));
}

// All parts in the frame of the world, in one configuration. Meshes get the error of the mapping on
// top of their vertex error, spheres lose it of their radius; those that vanish cover nothing.
class PlacedRobot {
 public:
  PlacedRobot(const RobotDescription& robot, std::span<const LinkParts> parts,
              std::span<const double> configuration) {
    forward_kinematics(robot.model, configuration, world_from_link_);
    for (const LinkParts& part : parts) {
      const double reach = reach_of(part);
      const Pose& pose = world_from_link_[part.index];
      const double error = map_error(kinematics_error_bound(robot.model, reach), reach, pose);
      errors_.push_back(error);
      largest_error_ = std::max(largest_error_, error);
      for (const Sphere& sphere : part.spheres) {
        const double radius = sub_down(sphere.radius, error);
        if (radius >= 0.0) spheres_.push_back({pose * sphere.center, radius});
      }
    }
  }

  // The mesh of a part.
  TriangleMesh mesh(const LinkParts& part) const {
    TriangleMesh mesh = *part.mesh;
    for (Vector3d& vertex : mesh.vertices) vertex = world_from_link_[part.index] * vertex;
    mesh.vertex_error = add_up(mesh.vertex_error, errors_[part.index]);
    return mesh;
  }

  // By how much a leak that is found may be shallower on the exact mechanism, and at curved shapes.
  double error_of_leak(const LinkParts& part) const {
    return add_up(add_up(errors_[part.index], largest_error_), part.chord_error);
  }

  std::span<const Sphere> spheres() const { return spheres_; }

 private:
  std::vector<Pose> world_from_link_;
  std::vector<double> errors_;
  double largest_error_ = 0.0;
  std::vector<Sphere> spheres_;
};

ConfigurationAudit audit_placed(const PlacedRobot& placed, std::span<const LinkParts> parts,
                                const std::vector<LinkAudit>& links, int threads) {
  ConfigurationAudit result;
  Bounds deepest;
  for (const LinkParts& part : parts) {
    // What a link's own spheres cover they cover everywhere.
    if (!part.mesh || links[part.index].certificate->covered) continue;
    const Certificate certificate =
        certify(placed.mesh(part), placed.spheres(),
                {.protrusion_tolerance = 0.0, .volume = false, .threads = threads});
    if (certificate.covered) continue;
    const Bounds depth = {
        std::max(0.0, sub_down(certificate.uncovered_depth.lower, placed.error_of_leak(part))),
        certificate.uncovered_depth.upper};
    if (result.deepest_link.empty() ||
        std::pair(depth.lower, depth.upper) > std::pair(deepest.lower, deepest.upper)) {
      deepest = depth;
      result.deepest_link = part.link;
      result.deepest_leak.reset();
      if (depth.lower > 0.0) result.deepest_leak = certificate.deepest_leak;
    }
    result.uncovered_depth.lower = std::max(result.uncovered_depth.lower, depth.lower);
    result.uncovered_depth.upper = std::max(result.uncovered_depth.upper, depth.upper);
  }
  return result;
}

// What is proved of a mesh around curved shapes holds of these, which are in it and come within the
// chord error of all its points: leaks are that much shallower at most, spheres protrude by that
// much more at most, and so much deeper their surface may leak, but not deeper than the whole.
Certificate within_chord_error(Certificate result, double chord_error) {
  if (chord_error == 0.0) return result;
  for (Bounds* depth : {&result.surface_depth, &result.solid_depth, &result.uncovered_depth}) {
    depth->lower = std::max(0.0, sub_down(depth->lower, chord_error));
  }
  Bounds& surface = result.surface_depth;
  surface.upper = std::min(add_up(surface.upper, chord_error), result.uncovered_depth.upper);
  if (result.protrusion_over_mesh) {
    result.protrusion_over_mesh->upper = add_up(result.protrusion_over_mesh->upper, chord_error);
  }
  return result;
}

// The certificate and the warnings of a link with geometry.
void certify_link(const LinkParts& part, const LinkDescription& link,
                  const RobotAuditOptions& options, LinkAudit& audit) {
  const auto exact =
      internal::protrusion_over_primitives(link_shapes(link, options.geometry), part.spheres);
  // Spheres that are what the link is made of; triangles around them would leak by their chords.
  if (exact && *exact == 0.0 &&
      internal::lie_in_single_spheres(link_shapes(link, options.geometry), part.spheres)) {
    Certificate& own = audit.certificate.emplace();
    own.covered = true;
    own.protrusion_over_mesh.emplace();
    own.volume_ratio = 1.0;
    own.sphere_count = part.spheres.size();
    return;
  }
  const Certificate around = certify(*part.mesh, part.spheres, {.threads = options.threads});
  audit.certificate = within_chord_error(around, part.chord_error);
  Certificate& of_mesh = *audit.certificate;
  const internal::PrimitiveLeak leak = internal::leak_of_primitives(
      link_shapes(link, options.geometry), part.spheres, of_mesh.deepest_leak);
  if (!of_mesh.covered && leak.depth > of_mesh.uncovered_depth.lower) {
    of_mesh.solid_depth.lower = of_mesh.uncovered_depth.lower = leak.depth;
    of_mesh.deepest_leak = leak.point;
  }
  if (exact && of_mesh.protrusion_over_mesh) {
    of_mesh.protrusion_over_mesh->upper = std::min(of_mesh.protrusion_over_mesh->upper, *exact);
  }
  if (!of_mesh.covered &&
      internal::lie_in_single_spheres(link_shapes(link, options.geometry), part.spheres)) {
    of_mesh.covered = true;
    of_mesh.surface_depth = of_mesh.solid_depth = of_mesh.uncovered_depth = Bounds{};
    of_mesh.deepest_leak.setZero();
    return;
  }
  // S holds the mesh around curved shapes, too.
  if (of_mesh.covered || around.uncovered_depth.lower > 0.0 || part.spheres.empty()) return;
  const auto mesh = link_mesh(
      link, {.geometry = options.geometry, .chord_error = options.max_error * kChordErrorOfError});
  const std::string fault =
      internal::size_fault(internal::box_of(*mesh).diagonal().norm(), options.max_error);
  if (!fault.empty()) {
    audit.warnings.push_back("it is not judged by a simplified solid: it " + fault);
    return;
  }
  const internal::LinkSolid solid(*mesh, {.max_error = options.max_error,
                                          .min_external_diameter = options.min_external_diameter,
                                          .threads = options.threads});
  Certificate of_solid = certify(*mesh, part.spheres, solid.certify_options());
  if (!of_solid.covered) return;
  of_solid.protrusion_over_mesh = of_mesh.protrusion_over_mesh;
  of_solid.volume_ratio = of_mesh.volume_ratio;
  audit.certificate = std::move(of_solid);
  const std::vector<std::string>& warnings = solid.warnings();
  audit.warnings.insert(audit.warnings.end(), warnings.begin(), warnings.end());
}

void warn_of_open_mesh(const TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const MeshReport report = mesh_report(mesh, {.self_intersections = false});
  if (report.closed) return;
  warnings.push_back(internal::openness(report) +
                     ": its surface is judged in any case, but space that its openings lead into "
                     "counts as outside");
}

// Before long work is done for nothing.
void check_configurations(const RobotDescription& robot,
                          const std::vector<std::vector<double>>& configurations) {
  std::vector<Pose> world_from_link;
  for (const std::vector<double>& configuration : configurations) {
    forward_kinematics(robot.model, configuration, world_from_link);
    for (const Joint& joint : robot.model.joints()) {
      if (!(std::abs(joint.position(configuration)) <= kLargestJointPosition)) {
        throw Error("configuration", "the position of joint " + joint.name + " is beyond 100");
      }
    }
  }
}

}  // namespace

RobotAudit audit_robot(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                       const RobotAuditOptions& options) {
  RobotAudit result;
  if (!(options.max_error > 0.0 && options.max_error <= kMaxCoordinate)) {
    throw Error("max error", "must be positive and finite");
  }
  check_configurations(robot, options.configurations);
  const std::vector<LinkParts> parts =
      internal::parts_of(robot, spheres, options.geometry, &result.unknown_links);
  const std::size_t steps = parts.size() + options.configurations.size();
  result.links_covered = true;
  for (const LinkParts& part : parts) {
    internal::report(options.progress, part.index, steps, part.link);
    if (part.first_equal != part.index) {
      result.links.push_back(result.links[part.first_equal]);
      result.links.back().link = part.link;
      continue;
    }
    LinkAudit audit{.link = part.link, .spheres = part.spheres.size()};
    if (part.mesh) {
      warn_of_open_mesh(*part.mesh, audit.warnings);
      internal::of_link(part.link,
                        [&] { certify_link(part, robot.links[part.index], options, audit); });
      if (!audit.certificate->covered) {
        audit.uncovered_share = uncovered_share(part);
        result.links_covered = false;
      }
    }
    result.links.push_back(std::move(audit));
  }
  result.configurations_covered = true;
  for (const std::vector<double>& configuration : options.configurations) {
    internal::report(options.progress, parts.size() + result.configurations.size(), steps,
                     "configurations");
    const PlacedRobot placed(robot, parts, configuration);
    result.configurations.push_back(audit_placed(placed, parts, result.links, options.threads));
    if (result.configurations.back().uncovered_depth.upper > 0.0) {
      result.configurations_covered = false;
    }
  }
  return result;
}

namespace {

// Before long work is done for nothing. An E that is chosen suits its link.
void check_sizes(std::span<const internal::LinkParts> parts, double max_error) {
  if (!(max_error > 0.0)) return;
  for (const internal::LinkParts& part : parts) {
    if (!part.mesh) continue;
    const double across = internal::box_of(*part.mesh).diagonal().norm();
    const std::string fault = internal::size_fault(across, max_error);
    if (!fault.empty()) throw Error(internal::subject_of(part.link), fault);
  }
}

LinkRepair repaired(const internal::LinkParts& part, const RobotRepairOptions& options) {
  const internal::LinkSolid solid(*part.mesh,
                                  {.max_error = options.max_error, .threads = options.threads});
  LinkRepair result{
      .link = part.link, .repair = {}, .certificate = {}, .warnings = solid.warnings()};
  result.repair = repair(*part.mesh, solid.external(), part.spheres,
                         {.max_error = options.max_error, .threads = options.threads});
  result.certificate = certify(*part.mesh, result.repair.spheres, solid.certify_options());
  return result;
}

}  // namespace

RobotRepair repair_robot(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                         const RobotRepairOptions& options) {
  RobotRepair result;
  result.spheres.assign(spheres.begin(), spheres.end());
  const std::vector<internal::LinkParts> parts =
      internal::parts_of(robot, spheres, options.geometry, nullptr);
  check_sizes(parts, options.max_error);
  std::vector<std::size_t> repair_of(parts.size());
  for (const internal::LinkParts& part : parts) {
    internal::report(options.progress, part.index, parts.size(), part.link);
    if (!part.mesh) continue;
    if (part.first_equal != part.index) {
      result.links.push_back(result.links[repair_of[part.first_equal]]);
      result.links.back().link = part.link;
    } else {
      result.links.push_back(internal::of_link(part.link, [&] { return repaired(part, options); }));
    }
    repair_of[part.index] = result.links.size() - 1;
    const std::vector<Sphere>& mended = result.links.back().repair.spheres;
    const auto there =
        std::find_if(result.spheres.begin(), result.spheres.end(),
                     [&](const LinkSpheres& link) { return link.link == part.link; });
    if (there != result.spheres.end()) {
      there->spheres = mended;
    } else {
      result.spheres.push_back({part.link, mended});
    }
  }
  return result;
}

}  // namespace spherule
