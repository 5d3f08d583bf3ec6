// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/link_spheres.h"

#include "spheretree/build.h"
#include "spheretree/error.h"
#include "spheretree/sphere_tree.h"

#include <memory>

namespace spherule {

RobotModel with_spheres(RobotModel robot, std::span<const LinkSpheres> spheres) {
  for (const LinkSpheres& link : spheres) {
    robot.require_link(link.link);
    if (!link.spheres.empty()) {
      robot.attach(link.link, std::make_shared<const SphereTree>(build_tree(link.spheres)));
    }
  }
  return robot;
}

}  // namespace spherule
