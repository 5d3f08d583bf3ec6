// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"
#include "spheretree/sphere.h"

#include <span>
#include <vector>

namespace spherule::internal {

// What rounding takes of rates, of products with them and of sums of these, relatively: no term is
// negative, so that the bounds below, sums over n joints of rates times sums over n joints, err by
// less than (3 n + 8) u of themselves, u being 2^-53. That is less for a million joints.
inline constexpr double kRelativeSlack = 1e-9;

// Of two bodies on a straight motion in joint space, over all of it, for each unit of its time.
struct PathBounds {
  double speed = 0.0;  // of a point of one, as seen from the other
  double bend = 0.0;   // half of what that velocity changes by: half an acceleration
};

// How far two bodies are at most from the axes of the joints between them, whatever these do, and
// what follows for motions. The proof is in path_reach.cpp.
class PathReach {
 public:
  struct Step {
    int joint = 0;
    bool turns = false;
    double first = 0.0;   // how far points of the first body are from the axis, without shifts
    double second = 0.0;  // of the second one
  };

  // The joints that move one of the two against the other, from the first body to the second; the
  // first body is in a sphere of the frame of its link, the second in another one, or else it
  // stands still. `link_poses` are those of the robot with all joints at zero; a point mapped by
  // them, or a direction times `error`, may be off by `error`.
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first);
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first, int second_link,
            const Sphere& second);

  // One for each joint, from the first body on.
  const std::vector<Step>& steps() const { return steps_; }

  // On a motion on which no joint's position changes by more than `rates` in all, and no prismatic
  // joint's magnitude exceeds `shifts` by more than the `error` above. Both are indexed by the
  // robot's joints.
  PathBounds bounds(std::span<const double> rates, std::span<const double> shifts,
                    std::vector<PathBounds>& work) const;

 private:
  std::vector<Step> steps_;
  bool second_moves_ = false;
};

}  // namespace spherule::internal
