// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"
#include "cli/robots/check_report.h"
#include "robot/check/robot_checker.h"
#include "robot/files/scene_file.h"
#include "robot/files/trajectory_file.h"
#include "robot/model/robot_model.h"

#include <string>

namespace spherule {

struct TrajectoryView {
  std::string file;
  bool has_motions = false;  // otherwise the verdicts are those of configurations
  ContinuousMotion continuous = ContinuousMotion::kAsGiven;
  int threads = 0;  // 0: all
  Progress progress{};
};

// What a page about the check of a trajectory shows.
struct CheckedScene {
  const RobotDescription& robot;
  std::string geometry;  // of which meshes are shown, as --geometry names it
  const SceneDescription& scene;
  const RobotChecker& checker;
  const Trajectory& trajectory;
  const CheckReport& report;
};

// Writes the page of `view` with the robot, its meshes where they can be read (otherwise with a
// warning), the spheres that were checked, the scene and the trajectory with its verdicts.
void write_check_page(const std::string& page, const CheckedScene& checked,
                      const TrajectoryView& view);

}  // namespace spherule
