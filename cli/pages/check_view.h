// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"
#include "cli/pages/view_page.h"
#include "cli/robots/check_report.h"
#include "cli/text/json.h"
#include "robot/check/robot_checker.h"
#include "robot/cover/link_mesh.h"
#include "robot/files/scene_file.h"
#include "robot/files/trajectory_file.h"
#include "robot/model/robot_model.h"

#include <cstddef>
#include <string>
#include <vector>

namespace spherule {

// What stands in a scene, in the world: meshes and primitives as triangles, points, spheres and
// trees as spheres, and what is attached to links of the robot, in their frames. Of a half-space,
// a square of its surface about the other obstacles. Parts have the names of the scene. Throws
// Error as link_mesh() and the readers do.
std::vector<ViewItem> view_obstacles(const SceneDescription& scene, const RobotModel& robot);

// Of longer trajectories a page shows so many configurations, evenly spread, the last one included;
// each step between two of them has the worst verdict of what is in it, and its first contact.
inline constexpr std::size_t kMostShownConfigurations = 10000;
// Of more contacts at one point a page shows so many, the deepest.
inline constexpr std::size_t kMostShownContacts = 8;

struct TrajectoryView {
  std::string file;
  bool has_motions = false;  // otherwise the verdicts are those of configurations
  ContinuousMotion continuous = ContinuousMotion::kAsGiven;
  int threads = 0;  // 0: all
  std::size_t most_configurations = kMostShownConfigurations;
  Progress progress{};
};

// A trajectory as the page takes it, `report` with the verdicts of it. Of n shown configurations:
// `lines` of the file, `positions`, `clearance` (its lower bound, metres) and `nearest` (two
// indices into `bodies`), as 32-bit words, and `skipped`, whether two links were anywhere left out
// of a clearance because they are proved free there; `verdicts`, a letter for each configuration,
// or for each step from one to the next where motions were proved: f free, c collision, u not
// proved, l outside the joint limits where these are enforced. `points` are what was examined and
// touches: "at" on the scale of the shown configurations, line, next line (0 for a configuration of
// the file), fraction, "configuration" unless it is a shown one, and contacts, 12 floats each: the
// two bodies, depth, point, and of either body link, tree and sphere, -1 for what has none.
Json view_trajectory(const RobotChecker& checker, const Trajectory& trajectory,
                     const CheckReport& report, const TrajectoryView& view);

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
