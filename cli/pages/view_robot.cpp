// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_robot.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/files/files.h"
#include "cli/pages/view_files.h"
#include "cli/pages/view_page.h"
#include "cli/robots/robot_input.h"
#include "robot/check/robot_collision.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/robot_spheres.h"
#include "robot/formats/sphere_formats.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>

namespace spherule {
namespace {

Json json_of(const FreeBoxes& boxes) {
  Json json{{"variables", Json::array()}};
  for (const FreeBoxes::Variable& variable : boxes.variables()) {
    json["variables"].push_back({{"index", variable.index},
                                 {"wraps", variable.wraps},
                                 {"lower", variable.lower},
                                 {"upper", variable.upper}});
  }
  std::string nodes;
  for (const char node : boxes.nodes()) nodes += static_cast<char>('A' + node);
  json["nodes"] = nodes;
  return json;
}

namespace fs = std::filesystem;

bool is_urdf(const std::string& file) {
  return recognize(file) == FileKind::kUrdf;
}

// What `robot` and `audit-robot --json` write.
bool is_by_links(const Json& json) {
  if (!json.is_object() || !json.contains("links") || !json["links"].is_array()) return false;
  return std::any_of(json["links"].begin(), json["links"].end(), [](const Json& link) {
    return link.is_object() && link.contains("link") && link.contains("certificate");
  });
}

const char* name_of(JointType type) {
  switch (type) {
    case JointType::kRevolute:
      return "revolute";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kFixed:
      break;
  }
  return "fixed";
}

// What a file says of links that the robot has not cannot be shown, but is not passed over in
// silence.
void add_unknown(std::size_t count, ViewItem& item) {
  if (count == 0) return;
  if (!item.facts.empty()) item.facts += "; ";
  item.facts += std::to_string(count) + (count == 1 ? " link" : " links") +
                " of the file left out: the robot has none of that name";
}

ViewItem sphere_item(const RobotDescription& robot, const RobotSpheres& spheres,
                     const std::string& file) {
  ViewItem item{.name = file, .parts = {}};
  std::size_t unknown = 0;
  for (const LinkSpheres& link : spheres.links) {
    const int index = robot.model.find_link(link.link);
    if (index < 0 && !link.spheres.empty()) ++unknown;
    if (index >= 0 && !link.spheres.empty()) {
      item.parts.push_back({build_tree(link.spheres), index});
    }
  }
  if (item.parts.empty()) throw Error(file, "has no spheres for a link of the robot");
  add_unknown(unknown, item);
  return item;
}

// Of the report of a robot's cover, which has the external spheres too, or of its audit.
std::vector<ViewItem> report_items(const RobotDescription& robot, const Json& json,
                                   const std::string& file) {
  ViewItem external{
      .name = "external spheres", .parts = {}, .external = true, .facts = {}, .shown = false};
  ViewItem leaks{.name = leaks_name(file), .parts = {}};
  std::size_t leaking = 0;
  std::size_t unknown = 0;
  for (const Json& entry : json.at("links")) {
    const auto certificate = entry.find("certificate");
    if (certificate == entry.end() || !certificate->is_object()) continue;
    const int link = robot.model.find_link(entry.at("link").get<std::string>());
    if (link < 0) {
      ++unknown;
      continue;
    }
    if (!certificate->at("covered").get<bool>()) ++leaking;
    leaks.parts.push_back({ViewLeaks{leaks_of(*certificate, file), {}}, link});
    const auto solid = entry.find("simplified_solid");
    if (solid == entry.end()) continue;
    if (const auto spheres = solid->find("external_spheres"); spheres != solid->end()) {
      external.parts.push_back({spheres_of(*spheres, file), link});
    }
  }
  leaks.facts = leaking == 0
                    ? "all links covered (proved)"
                    : std::to_string(leaking) + " of " + std::to_string(leaks.parts.size()) +
                          " links not proved to be covered";
  add_unknown(unknown, leaks);
  return {std::move(external), std::move(leaks)};
}

// As many numbers a posture as there are variables, and the lines of the file.
Json view_postures(const TrajectoryArguments& arguments, const RobotDescription& robot) {
  const Trajectory trajectory = read_configurations(arguments, robot).trajectory;
  const std::vector<float> positions(trajectory.positions.begin(), trajectory.positions.end());
  return {{"file", arguments.file},
          {"lines", trajectory.lines},
          {"positions", encode_words(positions)}};
}

bool is_sphere(const LinkShape& shape) {
  const auto* primitive = std::get_if<Primitive>(&shape.geometry);
  return primitive != nullptr && std::holds_alternative<SolidSphere>(*primitive);
}

bool has_spheres(const RobotDescription& robot) {
  return std::ranges::any_of(robot.links, [](const LinkDescription& link) {
    return std::ranges::any_of(link.collision, is_sphere);
  });
}

}  // namespace

bool is_of_pairs_alone(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".pairs") return true;
  const std::string text = read_file(file);
  const auto has = [&](const char* mark) { return text.find(mark) != std::string::npos; };
  return has("<robot") && has("<disable_collisions") && !has("<link_sphere_approximation");
}

Json view_pairs(const PairKinds& kinds) {
  Json json = Json::array();
  for (const PairStatus& pair : kinds.pairs) {
    Json& written =
        json.emplace_back(Json{{"links", {pair.first, pair.second}}, {"kind", kind_of(pair)}});
    if (pair.verdict) written["verdict"] = name_of(*pair.verdict);
    if (pair.reason == AllowedReason::kFreeInBoxes) {
      written["boxes"] = json_of(kinds.proofs->find(pair.first, pair.second)->boxes);
    }
  }
  return json;
}

Json view_pose(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  return Json::array({t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

namespace {

// What its slider goes through: a turn or two metres where the joint has no limits.
std::pair<double, double> slider_range(const Joint& joint) {
  if (std::isfinite(joint.upper)) return {joint.lower, joint.upper};
  const double half = joint.turns() ? std::numbers::pi : 1.0;
  return {-half, half};
}

}  // namespace

Json view_robot(const RobotDescription& robot) {
  Json json{{"name", robot.name}, {"links", Json::array()}, {"joints", Json::array()}};
  for (const Link& link : robot.model.links()) {
    json["links"].push_back({{"name", link.name}, {"joint", link.parent_joint}});
  }
  for (const Joint& joint : robot.model.joints()) {
    const std::pair<double, double> range = slider_range(joint);
    json["joints"].push_back({{"name", joint.name},
                              {"type", name_of(joint.type)},
                              {"parent", joint.parent_link},
                              {"origin", view_pose(joint.parent_from_joint)},
                              {"axis", to_json(joint.axis)},
                              {"lower", range.first},
                              {"upper", range.second},
                              {"variable", joint.variable},
                              {"multiplier", joint.mimics < 0 ? 1.0 : joint.multiplier},
                              {"offset", joint.mimics < 0 ? 0.0 : joint.offset}});
  }
  json["variables"] = robot.model.variable_joints();
  json["rest"] = rest_posture(robot.model).configuration;
  json["zero"] = zero_posture(robot.model).configuration;
  return json;
}

ViewItem view_meshes(const RobotDescription& robot, LinkGeometry geometry,
                     const std::string& name) {
  ViewItem item{.name = name + " geometry", .parts = {}};
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    LinkDescription link = robot.links[i];
    std::erase_if(link.collision, is_sphere);
    auto mesh = link_mesh(link, {.geometry = geometry});
    if (mesh) item.parts.push_back({std::move(*mesh), static_cast<int>(i)});
  }
  return item;
}

ViewScene covered_robot_scene(const RobotDescription& robot, const std::string& geometry,
                              const RobotSpheres& spheres, const std::string& name,
                              const Json& report) {
  ViewScene scene{.title = name, .items = {}, .robot = view_robot(robot)};
  ViewItem meshes = view_meshes(robot, geometry_named(geometry), geometry);
  if (!meshes.parts.empty()) scene.items.push_back(std::move(meshes));
  scene.items.push_back(sphere_item(robot, spheres, name));
  for (ViewItem& item : report_items(robot, report, name)) scene.items.push_back(std::move(item));
  place_leaks(scene.items);
  return scene;
}

bool is_robot_file(const std::string& file) {
  if (has_mesh_ending(file)) return false;
  const std::string ending = lower_ending(file);
  if (ending == ".json") {
    const internal::JsonDocument<Json> json = json_in(file);
    if (is_by_links(json)) return true;
    const bool ours = json.is_object() && (json.contains("deepest_leak") ||
                                           json.value("format", Json()) == "spherule-report" ||
                                           json.value("format", Json()) == "spherule-spheres");
    return !json.is_null() && !ours;
  }
  if (ending == ".yml" || ending == ".yaml" || ending == ".xrdf" || ending == ".pairs") return true;
  return read_file(file).find("<robot") != std::string::npos;
}

void add_robot(const std::vector<std::string>& files, const RobotViewOptions& options,
               ViewScene& scene) {
  if (files.empty()) {
    if (!options.postures.file.empty()) {
      throw Error(options.postures.file, "has postures of a robot: its URDF must be named too");
    }
    return;
  }
  const auto urdf = std::find_if(files.begin(), files.end(), is_urdf);
  if (urdf == files.end()) {
    throw Error(files.front(), "belongs to a robot: its URDF must be named too");
  }
  std::vector<LinkGeometry> shown;
  for (const std::string& name : options.geometry) shown.push_back(geometry_named(name));
  const RobotDescription robot = read_urdf_with_warnings(*urdf, options.packages, shown);
  scene.title = *urdf;
  scene.robot = view_robot(robot);
  if (!options.postures.file.empty()) {
    scene.robot["postures"] = view_postures(options.postures, robot);
  }
  for (const std::string& name : options.geometry) {
    ViewItem item = view_meshes(robot, geometry_named(name), name);
    item.shown = name == options.geometry.front();
    if (!item.parts.empty()) scene.items.push_back(std::move(item));
  }
  PairSources pairs;
  std::optional<RobotSpheres> first_spheres;  // to which the pairs belong
  for (const std::string& file : files) {
    if (file == *urdf && !has_spheres(robot)) continue;
    if (file != *urdf && is_of_pairs_alone(file)) {
      std::string& source = fs::path(file).extension() == ".pairs" ? pairs.pairs : pairs.srdf;
      if (!source.empty()) throw Error(file, "is the second file of pairs of links; one is shown");
      source = file;
      continue;
    }
    if (const auto document = json_in(file); is_by_links(document)) {
      std::vector<ViewItem> items =
          blame_file<Json::exception>(file, [&] { return report_items(robot, document, file); });
      std::move(items.begin(), items.end(), std::back_inserter(scene.items));
      continue;
    }
    const LinkGeometry geometry = geometry_named(options.geometry.front());
    SphereInput spheres = read_spheres_of(robot, geometry, file);
    require_known_links(robot.model, file, spheres.file.spheres, options.ignores_unknown_links);
    scene.items.push_back(sphere_item(robot, spheres.file.spheres, file));
    if (first_spheres) continue;
    first_spheres = std::move(spheres.file.spheres);
    scene.robot["pairs_of"] = file;
  }
  if (first_spheres) {
    scene.robot["pairs"] = view_pairs(
        pair_kinds(robot, *first_spheres, geometry_named(options.geometry.front()), pairs));
  } else if (!pairs.is_empty()) {
    throw Error(*urdf, "pairs of its links are told apart with its spheres: name a file of them");
  }
}

}  // namespace spherule
