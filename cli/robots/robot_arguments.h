// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/options/external_spheres_flag.h"
#include "cli/options/length_options.h"
#include "cli/options/robot_options.h"
#include "cli/robots/robot_false_alarms.h"
#include "cli/robots/robot_files.h"
#include "robot/cover/robot_spheres.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// What the command `robot` is given.
struct RobotArguments {
  std::string urdf;
  std::string folder;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  std::vector<std::string> links;
  std::vector<std::string> formats = robot_format_names();
  std::string srdf;
  std::string curobo;
  std::string xrdf;
  std::string tool_link;
  bool json = false;
  std::string view;
  bool has_max_error = false;
  ReportContent report_content = ReportContent::kNoExternalSpheres;
  FalseAlarmArguments false_alarms;
  RobotCoverOptions options;
  LengthOptions lengths;
};

// Adds them to the command, which they have to outlive.
void add_robot_options(CLI::App& command, RobotArguments& arguments);

}  // namespace spherule
