// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_files.h"

#include "base/error.h"
#include "base/text.h"
#include "robot/check/robot_collision.h"
#include "robot/check/scene_setup.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/srdf_judgement.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"

#include <climits>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTree = "tree";

std::string checked_name(const std::string& name, const fs::path& urdf) {
  if (name.empty() || name.find_first_of(std::string("/\0", 2)) != std::string::npos) {
    throw Error(urdf.string(),
                "the name " + internal::in_quotes(name) + " cannot be part of that of a file");
  }
  return name;
}

// Some published robots have links as r2/waist.
std::string part_of_file_name(std::string link) {
  for (std::size_t at = link.find('/'); at != std::string::npos; at = link.find('/', at)) {
    link.replace(at, 1, "%2F");
  }
  return link;
}

// Down from the root as long as only one way leads on: only one that has joints that move or, past
// the last of those, only one at all.
std::string last_link(const RobotModel& model) {
  const std::size_t count = model.links().size();
  std::vector<bool> moves(count, false);  // a joint at the link or below it
  std::vector<std::vector<std::size_t>> children(count);
  for (std::size_t i = count; i-- > 1;) {
    const Joint& joint = model.joints()[static_cast<std::size_t>(model.links()[i].parent_joint)];
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    moves[i] = moves[i] || joint.moves();
    moves[parent] = moves[parent] || moves[i];
    children[parent].push_back(i);
  }
  std::size_t link = 0;
  for (;;) {
    std::vector<std::size_t> ways = children[link];
    if (moves[link]) std::erase_if(ways, [&](std::size_t child) { return !moves[child]; });
    if (ways.size() != 1) return model.links()[link].name;
    link = ways.front();
    // Whether the link's own joint moves does not matter any more.
    moves[link] = std::any_of(children[link].begin(), children[link].end(),
                              [&](std::size_t child) { return moves[child]; });
  }
}

fs::path original(const RobotFilePlan& plan, SphereFormat format) {
  switch (format) {
    case SphereFormat::kSrdf:
      return plan.srdf;
    case SphereFormat::kCurobo:
      return plan.curobo;
    case SphereFormat::kXrdf:
      return plan.xrdf;
    default:
      return {};
  }
}

SphereFileContext context_of(const RobotFilePlan& plan, const RobotDescription& robot,
                             SphereFormat format) {
  SphereFileContext context;
  context.urdf = format == SphereFormat::kCurobo ? plan.curobo_urdf(robot) : plan.urdf;
  context.original = original(plan, format);
  context.base_link = robot.model.links().front().name;
  context.tool_link = plan.tool_link.empty() ? last_link(robot.model) : plan.tool_link;
  context.joint_positions = rest_posture(robot.model).configuration;
  for (const int index : robot.model.variable_joints()) {
    const Joint& joint = robot.model.joints()[static_cast<std::size_t>(index)];
    context.joint_names.push_back(joint.name);
  }
  return context;
}

bool writes(const RobotFilePlan& plan, SphereFormat format) {
  return std::ranges::any_of(
      plan.formats, [&](const std::string& name) { return sphere_format_named(name) == format; });
}

bool is_for_xacro(const fs::path& urdf) {
  return urdf.extension() == ".xacro";
}

}  // namespace

std::vector<std::string> robot_format_names() {
  return {"urdf", "srdf", "curobo", "xrdf", "foam", "json", kTree, kPairsFormat};
}

fs::path RobotFilePlan::curobo_urdf(const RobotDescription& robot) const {
  if (!is_for_xacro(urdf) || !writes(*this, SphereFormat::kUrdf)) return urdf;
  return folder / sphere_file_name(robot.name, SphereFormat::kUrdf);
}

bool RobotFilePlan::names_xacro_for_curobo(const RobotDescription& robot) const {
  return writes(*this, SphereFormat::kCurobo) && curobo.empty() && is_for_xacro(curobo_urdf(robot));
}

fs::path RobotFilePlan::report(const RobotDescription& robot) const {
  return folder / (checked_name(robot.name, urdf) + ".report.json");
}

fs::path RobotFilePlan::pairs(const RobotDescription& robot) const {
  return folder / (checked_name(robot.name, urdf) + ".pairs");
}

fs::path RobotFilePlan::tree(const RobotDescription& robot, const std::string& link) const {
  return folder / (checked_name(robot.name, urdf) + "." +
                   checked_name(part_of_file_name(link), urdf) + ".tree");
}

std::vector<fs::path> RobotFilePlan::all(const RobotDescription& robot,
                                         const std::vector<std::string>& links) const {
  std::vector<fs::path> files;
  for (const std::string& format : formats) {
    if (format == kTree) {
      for (const std::string& link : links) files.push_back(tree(robot, link));
    } else if (format == kPairsFormat) {
      files.push_back(pairs(robot));
    } else {
      files.push_back(folder / sphere_file_name(robot.name, *sphere_format_named(format)));
    }
  }
  files.push_back(report(robot));
  std::set<fs::path> different;
  for (const fs::path& file : files) {
    if (!different.insert(file).second) throw Error(file.string(), "is a file of two links");
    if (file.filename().string().size() > NAME_MAX) {
      throw Error(file.string(), "cannot be written: the name is too long");
    }
  }
  return files;
}

void rehearse_robot_files(const RobotFilePlan& plan, const RobotDescription& robot,
                          const std::vector<std::string>& links) {
  RobotSpheres spheres;
  spheres.robot = robot.name;
  for (const std::string& link : links) {
    for (const LinkSpheres& other : spheres.links) {
      spheres.self_collision_ignore.push_back({other.link, link, std::string(kProvedNeverReason)});
    }
    spheres.links.push_back({link, {Sphere{Eigen::Vector3d::Zero(), 1.0}}});
  }
  for (const std::string& name : plan.formats) {
    const std::optional<SphereFormat> format = sphere_format_named(name);
    if (!format) continue;  // trees and proofs can always be written
    const fs::path file = plan.folder / sphere_file_name(robot.name, *format);
    try {
      check_robot_spheres(spheres, *format, context_of(plan, robot, *format), file);
    } catch (const Error& error) {
      if (error.subject() != file.string()) throw;
      // What is wrong with names of a file that is not written yet is wrong with the URDF.
      throw Error(plan.urdf.string(),
                  error.reason() + ", which " + file.filename().string() + " cannot hold");
    }
  }
}

void write_robot_files(const RobotFilePlan& plan, const RobotDescription& robot,
                       const RobotSpheres& spheres, const LinkPairs* pairs) {
  std::error_code fault;
  fs::create_directory(plan.folder, fault);
  if (fault) throw Error(plan.folder.string(), fault.message());
  for (const std::string& name : plan.formats) {
    if (name == kTree) {
      for (const LinkSpheres& link : spheres.links) {
        if (link.spheres.empty()) continue;
        save_tree(build_tree(link.spheres), plan.tree(robot, link.link));
      }
      continue;
    }
    if (name == kPairsFormat) {
      if (pairs != nullptr) save_link_pairs(*pairs, plan.pairs(robot));
      continue;
    }
    const SphereFormat format = *sphere_format_named(name);
    write_robot_spheres(spheres, format, context_of(plan, robot, format),
                        plan.folder / sphere_file_name(robot.name, format));
  }
}

}  // namespace spherule
