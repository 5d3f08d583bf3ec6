// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Covers a robot so that its spheres refuse few free postures.

#include "robot/cover/link_errors.h"
#include "robot/cover/robot_spheres.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

// The bodies that the spheres of cover_robot() cover: the meshes of the links, of the geometry that
// is requested, welded as requested and each grown by the padding of its link. Throws Error as
// link_bodies().
std::vector<LinkBody> covered_bodies(const RobotDescription& robot,
                                     const RobotCoverOptions& options);

// A robot's cover, and how the E of its links was chosen.
struct GoalCover {
  RobotCover cover;
  LinkErrorChoice choice;
};

// Covers a robot by choose_link_errors(): E link by link for few spheres that refuse at most
// `goal.goal` of the free postures. `bodies` are covered_bodies(); what is proved of their pairs is
// `proofs`, or null. Pairs by name in `disabled` are not tested, nor are those of
// AllowedCollisions.
//
// Links with a max error of their own in `options.links` keep it; options.max_error is not used: in
// the cover's options, it is the coarsest E.
// The search is done by first covers, those of an effort of 0; what is chosen is covered with the
// options' effort. Otherwise as cover_robot(), whose promises hold. Throws Error as both.
GoalCover cover_robot_to_goal(const RobotDescription& robot, std::span<const LinkBody> bodies,
                              std::span<const DisabledPair> disabled, const LinkPairs* proofs,
                              const RobotCoverOptions& options, const LinkErrorOptions& goal = {});

}  // namespace spherule
