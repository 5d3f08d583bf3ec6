// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/sphere_input.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/text/message.h"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <vector>

namespace spherule {
namespace {

std::string only_link(const RobotDescription& robot, LinkGeometry geometry,
                      const std::string& file) {
  std::vector<std::string> names;
  for (const LinkDescription& link : robot.links) {
    if (!link_shapes(link, geometry).empty()) names.push_back(link.name);
  }
  if (names.size() != 1) throw Error(file, kNameItsLink);
  return names.front();
}

}  // namespace

void add_unknown_links_flag(CLI::App& command, bool& ignores) {
  command.add_flag(
      "--ignore-unknown-links", ignores,
      "Leave out spheres of links that the robot has not got, with a warning (default: "
      "refuse the file)");
}

void require_known_links(const RobotModel& robot, const std::string& file,
                         const RobotSpheres& spheres, bool ignores) {
  constexpr std::size_t kMostNamed = 5;
  std::size_t known = 0;
  std::size_t unknown = 0;
  std::string names;
  for (const LinkSpheres& link : spheres.links) {
    if (link.spheres.empty()) continue;
    if (robot.find_link(link.link) >= 0) {
      ++known;
    } else if (++unknown <= kMostNamed) {
      names += (unknown == 1 ? " " : ", ") + internal::in_quotes(link.link);
    }
  }
  if (unknown == 0) return;
  if (unknown > kMostNamed) names += " and " + std::to_string(unknown - kMostNamed) + " more";
  const std::string what = "has spheres of " + std::to_string(unknown) +
                           (unknown == 1 ? " link" : " links") +
                           " that the robot has not got:" + names;
  if (known == 0) throw Error(file, what + ", and of no other");
  if (!ignores) throw Error(file, what + "; --ignore-unknown-links leaves them out");
  warn(file + ": " + what + "; they are left out");
}

void warn_of_other_geometry(const std::string& file, const RobotSpheres& spheres) {
  if (spheres.self_collision_geometry.empty()) return;
  warn(file + ": the geometry " + internal::in_quotes(spheres.self_collision_geometry) +
       " that it names for self-collisions is not read: these are checked with the spheres of the "
       "geometry for collisions, too");
}

SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options) {
  SphereInput input{read_robot_spheres(file, options)};
  warn_of_other_geometry(file, input.file.spheres);
  if (is_of_one_mesh(input.file)) {
    input.file.spheres.links.front().link = only_link(robot, geometry, file);
    input.names_links = false;
  }
  return input;
}

}  // namespace spherule
