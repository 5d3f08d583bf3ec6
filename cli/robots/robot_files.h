// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// The name of the file of pairs among the formats.
inline constexpr const char* kPairsFormat = "pairs";

// What --format takes: the names of the formats that are written, "tree", and kPairsFormat.
std::vector<std::string> robot_format_names();

// The files of `spherule robot`.
struct RobotFilePlan {
  std::filesystem::path folder;
  std::filesystem::path urdf;
  std::vector<std::string> formats;  // names
  // Files of these formats of which all but the spheres is kept; empty: new ones.
  std::filesystem::path srdf;
  std::filesystem::path curobo;
  std::filesystem::path xrdf;
  std::string tool_link;  // empty: where the robot's chain of moving joints ends or branches

  // What a cuRobo file names as its URDF. Of one for xacro, which cuRobo cannot read, that is the
  // spherized URDF, which is expanded, if it is written, too.
  std::filesystem::path curobo_urdf(const RobotDescription& robot) const;
  // Whether a cuRobo file is written that names a URDF for xacro.
  bool names_xacro_for_curobo(const RobotDescription& robot) const;
  std::filesystem::path report(const RobotDescription& robot) const;
  std::filesystem::path pairs(const RobotDescription& robot) const;
  std::filesystem::path tree(const RobotDescription& robot, const std::string& link) const;
  // All that will be written for a robot of which these links get spheres. Throws Error for names
  // that cannot be names of files.
  std::vector<std::filesystem::path> all(const RobotDescription& robot,
                                         const std::vector<std::string>& links) const;
};

// Throws what write_robot_files() would throw whatever the spheres, before long work is done for
// nothing: for a file to be kept that cannot be read, a name that a format cannot hold. It makes
// the texts of files of one sphere a link, in which all pairs are ignored, and writes none.
void rehearse_robot_files(const RobotFilePlan& plan, const RobotDescription& robot,
                          const std::vector<std::string>& links);

// Makes the folder if it is not there and writes the files, but for the report; none of pairs if
// nothing was proved (null). Throws Error.
void write_robot_files(const RobotFilePlan& plan, const RobotDescription& robot,
                       const RobotSpheres& spheres, const LinkPairs* pairs);

}  // namespace spherule
