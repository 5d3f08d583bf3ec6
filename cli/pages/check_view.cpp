// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/check_view.h"

#include "base/error.h"
#include "cli/options/robot_options.h"
#include "cli/pages/page_output.h"
#include "cli/pages/view_obstacles.h"
#include "cli/pages/view_page.h"
#include "cli/pages/view_robot.h"
#include "cli/text/message.h"

#include <utility>
#include <vector>

namespace spherule {
namespace {

ViewItem checked_spheres(const RobotModel& robot) {
  ViewItem item{.name = "checked spheres", .parts = {}, .checked = true};
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      item.parts.push_back({*tree, static_cast<int>(link)});
    }
  }
  return item;
}

ViewScene scene_of(const CheckedScene& checked, const TrajectoryView& view) {
  ViewScene scene{.title = view.file, .items = {}};
  scene.robot = view_robot(checked.robot);
  scene.robot["pose"] = view_pose(checked.scene.world_from_root);
  try {
    ViewItem meshes =
        view_meshes(checked.robot, geometry_named(checked.geometry), checked.geometry);
    if (!meshes.parts.empty()) scene.items.push_back(std::move(meshes));
  } catch (const Error& error) {
    warn(std::string("the page shows no meshes of the robot: ") + error.what());
  }
  scene.items.push_back(checked_spheres(checked.checker.robot()));
  for (ViewItem& item : view_obstacles(checked.scene, checked.robot.model)) {
    scene.items.push_back(std::move(item));
  }
  scene.trajectory = view_trajectory(checked.checker, checked.trajectory, checked.report, view);
  return scene;
}

}  // namespace

void write_check_page(const std::string& page, const CheckedScene& checked,
                      const TrajectoryView& view) {
  write_page(page, scene_of(checked, view));
}

}  // namespace spherule
