// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/check_spheres.h"

#include "base/error.h"
#include "cli/files/in_file.h"
#include "cli/robots/link_warnings.h"
#include "cli/robots/sphere_input.h"
#include "cli/text/message.h"
#include "cli/text/progress.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/link_spheres.h"

#include <cstddef>
#include <utility>

namespace spherule {
namespace {

// Whether there are none: links that have a shape and no sphere, which would be free everywhere.
bool has_no_bare_links(const RobotDescription& robot, const RobotModel& model,
                       LinkGeometry geometry) {
  bool none = true;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (model.links()[i].trees.empty() && !link_shapes(robot.links[i], geometry).empty()) {
      warn("link " + robot.links[i].name + " has a shape but no spheres: it is not checked");
      none = false;
    }
  }
  return none;
}

}  // namespace

SphereRobot read_sphere_robot(const std::string& file, const RobotDescription& robot,
                              LinkGeometry geometry, bool ignores_unknown_links) {
  SphereFormatFile spheres = read_robot_spheres(file);
  // In which frame they are nobody says, and here nothing proves that they cover.
  if (is_of_one_mesh(spheres)) throw Error(file, kNameItsLink);
  RobotSpheres read = std::move(spheres.spheres);
  require_known_links(robot.model, file, read, ignores_unknown_links);
  warn_of_other_geometry(file, read);
  const auto is_unknown = [&](const std::string& link) { return robot.model.find_link(link) < 0; };
  std::erase_if(read.links, [&](const LinkSpheres& link) { return is_unknown(link.link); });
  std::erase_if(read.self_collision_ignore, [&](const DisabledPair& pair) {
    return is_unknown(pair.link_a) || is_unknown(pair.link_b);
  });
  const auto warn_of = [&](std::size_t count, const char* what) {
    if (count > 0) warn(file + ": " + std::to_string(count) + what);
  };
  warn_of(read.other_shapes, " shapes are no spheres: they are not checked");
  warn_of(read.switched_off, " spheres are switched off: they are not checked");
  if (!read.self_collision_ignore.empty()) {
    tell(file + ": " + std::to_string(read.self_collision_ignore.size()) +
         " of the pairs of links are ignored, as the file says");
  }
  if (read.collision_buffer != 0.0 || !read.collision_buffers.empty() ||
      !read.self_collision_buffer.empty()) {
    warn(file + ": its buffers are not added; name them as padding in the scene");
  }
  SphereRobot result{in_file(file, [&] { return with_spheres(robot.model, read.links); }),
                     std::move(read.self_collision_ignore)};
  result.is_whole = has_no_bare_links(robot, result.model, geometry) && read.other_shapes == 0;
  return result;
}

SphereRobot cover_sphere_robot(const std::string& urdf, const RobotDescription& robot,
                               RobotCoverOptions options) {
  LinkWarnings warnings;
  const RobotCover covered = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    options.on_doubt = warnings.on_doubt(bar);
    return in_file(urdf, [&] { return cover_robot(robot, options); });
  }();
  std::vector<LinkSpheres> spheres;
  for (const LinkCover& link : covered.links) {
    if (link.fit && !link.fit->certificate.covered) {
      throw Error(urdf, "link " + link.link + ": its spheres are not proved to cover all of it");
    }
    warnings.print(link.link, link.warnings);
    spheres.push_back({link.link, link.spheres});
  }
  SphereRobot result{with_spheres(robot.model, spheres), {}};
  result.is_whole = has_no_bare_links(robot, result.model, options.geometry);
  return result;
}

}  // namespace spherule
