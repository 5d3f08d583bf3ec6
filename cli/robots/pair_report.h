// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "robot/check/scene_setup.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/srdf_judgement.h"

#include <string>
#include <vector>

namespace spherule {

// The name of a link by its index.
const std::string& link_name(const RobotModel& robot, int link);

// What is proved of the pairs of a robot's links: how many there are of each kind, and every pair
// with its verdict, the posture in which the two touch (by joints; radians or metres), the smallest
// gap found (metres), and the share of the postures within the limits that is proved free.
Json pair_summary(const LinkPairs& pairs, const RobotModel& robot, double seconds);

// What touches in postures.
Json to_json(const std::vector<PostureContact>& contacts);

// A pair of an SRDF with its verdict, the posture in which the two touch and the smallest gap
// found.
Json to_json(const JudgedPair& judged, const RobotModel& robot);

// `link_2 and link_6 ("Never")`.
std::string describe(const DisabledPair& pair);

// What is wrong with the disabled pairs of an SRDF, a warning each: two links that touch.
std::vector<std::string> wrong_pairs(const SrdfJudgement& judgement, const RobotModel& robot);

// The counts, for a person.
std::string describe_link_pairs(const LinkPairs& pairs, double seconds);

// A posture by the names of the joints, radians and metres.
Json posture_json(const RobotModel& robot, const std::vector<double>& configuration);

// A posture of a robot as a person reads it: joints by name, degrees and metres.
std::string describe_posture(const RobotModel& robot, const std::vector<double>& configuration);

// What touches in postures, as warnings: first where the meshes do, then where the spheres alone
// do. Of many of a kind the first, or the deepest, and how many more there are.
std::vector<std::string> contact_warnings(const std::vector<PostureContact>& contacts);

}  // namespace spherule
