// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sphere_input.h"

#include "spheretree/error.h"

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

SphereInput read_spheres_of(const RobotDescription& robot, LinkGeometry geometry,
                            const std::string& file, const SphereReadOptions& options) {
  SphereInput input{read_robot_spheres(file, options)};
  if (is_of_one_mesh(input.file)) {
    input.file.spheres.links.front().link = only_link(robot, geometry, file);
    input.names_links = false;
  }
  return input;
}

}  // namespace spherule
