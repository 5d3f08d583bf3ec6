// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"

#ifdef SPHERULE_HAS_ROBOT
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/joint_positions.h"
#endif

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {
namespace {

std::string describe_sphere(const char* what, const Sphere& sphere) {
  const Eigen::Vector3d& center = sphere.center;
  return concat(what, ": center (", center.x(), ", ", center.y(), ", ", center.z(), "), radius ",
                sphere.radius, "\n");
}

std::string describe(const BodyRecord& body, const std::vector<BodyRecord>& bodies) {
  return concat("  ", one_line(body.name), ": ", body.sphere_count, " spheres, ",
                body.certificate && body.certificate->covered ? "covered" : "not covered",
                body.copy ? ", copy of " + one_line(bodies[body.copy->of].name) : "",
                body.interrupted ? ", interrupted" : "", "\n");
}

std::string describe(const CertificateRecord& certificate) {
  std::string text =
      concat("certificate (as stored, not proved again): ",
             certificate.covered ? "covered" : "not covered", ", uncovered depth ",
             certificate.uncovered_depth_lower, " to ", certificate.uncovered_depth_upper, "\n");
  const std::pair<const char*, std::optional<double>> kBounds[] = {
      {"protrusion over the simplified solid, at most", certificate.protrusion_over_simplified_max},
      {"protrusion over the mesh, at most", certificate.protrusion_over_mesh_max},
      {"volume ratio", certificate.volume_ratio},
      {"volume that stage 1 filled, about", certificate.filled_volume},
      {"ways into the part are filled up to D and this much, at most", certificate.closing_slack}};
  for (const auto& [what, value] : kBounds) {
    if (value) text += concat("  ", what, ": ", *value, "\n");
  }
  return text;
}

std::string describe(const SphereFile& file) {
  std::string text = concat("spheres: ", file.spheres.size(), "\n");
  if (!file.spheres.empty()) {
    const auto [smallest, largest] =
        std::ranges::minmax_element(file.spheres, {}, [](const Sphere& one) { return one.radius; });
    text += concat("radius: ", smallest->radius, " to ", largest->radius, "\n") +
            describe_sphere("enclosing sphere", enclosing_sphere(file.spheres));
  }
  if (file.interrupted) text += concat(kInterruptedSearch, "\n");
  if (!file.bodies.empty()) text += concat("bodies: ", file.bodies.size(), "\n");
  for (const BodyRecord& body : file.bodies) text += describe(body, file.bodies);
  for (const auto& [name, value] : file.options) {
    const std::string shown = std::visit([](const auto& v) { return concat(v); }, value);
    text += one_line("option " + name + ": " + shown) + "\n";
  }
  return text + (file.certificate ? describe(*file.certificate) : "certificate: none\n");
}

std::string describe(const SphereTree& tree) {
  const TreeReport report = check(tree);
  return concat("tree: ", report.sphere_count, " spheres, ", report.node_count, " nodes, ",
                report.leaf_count, " leaves, depth ", report.depth, ", branching ",
                report.branching, "\ninvariants: ", report.valid ? "all hold" : "broken",
                "\nmean inflation of a level: ", report.mean_inflation, "\n") +
         describe_sphere("root", tree.sphere(0));
}

std::string describe_model(const std::string& file) {
  ModelUnit unit = model_unit(file, {});
  const ModelFile model = read_model(file);
  if (model.cad) note_cad_unit(model.cad->stated_unit, unit);
  return (model.cad ? describe(*model.cad) : "") + describe(unit) +
         describe(mesh_report(model.mesh)) + "\n";
}

#ifdef SPHERULE_HAS_ROBOT
std::string describe(const Joint& joint) {
  if (joint.type == JointType::kContinuous) return one_line(joint.name) + ": continuous";
  if (!has_limits(joint)) return one_line(joint.name) + ": no limits";
  return concat(one_line(joint.name), ": ", joint.lower, " to ", joint.upper,
                joint.turns() ? " rad" : " m");
}

std::size_t count_spheres(const std::vector<LinkSpheres>& links) {
  std::size_t count = 0;
  for (const LinkSpheres& link : links) count += link.spheres.size();
  return count;
}

// No mesh is read.
std::string describe_urdf(const std::string& file) {
  const RobotDescription robot = read_urdf(
      file, {.packages = {}, .require_visual_meshes = false, .require_collision_meshes = false});
  const RobotModel& model = robot.model;
  for (const std::string& warning : robot.warnings) warn(warning);
  const auto visual = std::ranges::count(
      robot.links, false, [](const LinkDescription& link) { return link.visual.empty(); });
  const auto collision = std::ranges::count(
      robot.links, false, [](const LinkDescription& link) { return link.collision.empty(); });
  std::string text = concat("robot: ", one_line(robot.name), "\nlinks: ", robot.links.size(), ", ",
                            collision, " with collision geometry, ", visual,
                            " with visual geometry\njoints: ", model.joints().size(), ", ",
                            std::ranges::count(model.joints(), JointType::kFixed, &Joint::type),
                            " fixed; numbers of a configuration: ", model.variable_count(), "\n");
  for (const Joint& joint : model.joints()) {
    if (joint.moves() && joint.mimics < 0) text += "  " + describe(joint) + "\n";
  }
  return text;
}

std::string describe_srdf(const std::string& file) {
  const SemanticDescription semantics = read_srdf(file);
  for (const std::string& warning : semantics.warnings) warn(warning);
  return concat("SRDF of robot: ", one_line(semantics.robot_name),
                "\ngroups: ", semantics.groups.size(),
                ", named states: ", semantics.group_states.size(),
                ", end effectors: ", semantics.end_effectors.size(),
                "\ndisabled pairs of links: ", semantics.disabled_pairs.size(),
                ", links disabled by default: ", semantics.links_disabled_by_default.size(),
                ", enabled pairs: ", semantics.enabled_pairs.size(),
                "\nspheres: ", count_spheres(semantics.sphere_approximations), "\n");
}

std::string describe_robot_spheres(const std::string& file) {
  const SphereFormatFile read = read_robot_spheres(file);
  const RobotSpheres& spheres = read.spheres;
  std::string text =
      concat("spheres of a robot (", name_of(read.format), ")",
             spheres.robot.empty() ? "" : ": " + one_line(spheres.robot),
             "\nspheres: ", count_spheres(spheres.links), " on ", spheres.links.size(), " links\n");
  if (spheres.interrupted) text += concat(kInterruptedSearch, "\n");
  for (const LinkSpheres& link : spheres.links) {
    text += concat("  ", one_line(link.link), ": ", link.spheres.size(), "\n");
  }
  if (spheres.switched_off > 0) text += concat("switched off: ", spheres.switched_off, "\n");
  const std::size_t left_out = spheres.self_collision_ignore.size();
  return text + (left_out > 0 ? concat("pairs of links left out: ", left_out, "\n") : "");
}
#endif

bool is_interrupted_report(const std::string& file) {
  const auto refuse = [&](const std::string& reason) { throw Error(file, reason); };
  const auto report = internal::parse_json<Json>(read_file(file), refuse);
  return report.is_object() && report.value("interrupted", Json()) == true;
}

std::string describe_file(const std::string& file) {
  const FileKind kind = recognize(file);
  switch (kind) {
    case FileKind::kSpheres:
      return describe(load_spheres(file));
    case FileKind::kTree:
      return describe(load_tree(file));
#ifdef SPHERULE_HAS_ROBOT
    case FileKind::kUrdf:
      return describe_urdf(file);
    case FileKind::kSrdf:
      return describe_srdf(file);
    case FileKind::kRobotSpheres:
      return describe_robot_spheres(file);
#endif
    case FileKind::kMesh:
    case FileKind::kCad:
    case FileKind::kUnknown:  // the reader of meshes says what it takes
      return describe_model(file);
    default:
      break;
  }
  const std::string text = one_line(offer_for(kind, file)) + "\n";
  const bool is_interrupted = kind == FileKind::kReport && is_interrupted_report(file);
  return text + (is_interrupted ? concat(kInterruptedSearch, "\n") : "");
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("info", "Say what is in a file of any kind that spherule reads or writes");
  auto file = std::make_shared<std::string>();
  add_file_argument(*command, "file", *file, "The file; its content tells what it is");
  command->footer(to_text({.text = "",
                           .exit_codes = "0 done",
                           .examples = {"spherule info part.stl", "spherule info part.json",
                                        "spherule info robot.urdf"}}));
  command->callback([file, &exit_code] {
    std::cout << describe_file(*file);
    exit_code = kYes;
  });
}

}  // namespace spherule
