// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "robot/check/robot_collision.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/robot_spheres.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/srdf_judgement.h"

#include <memory>
#include <optional>
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

// Its counts, for a person.
std::string describe_link_pairs(const Json& summary);

// A posture by the names of the joints, radians and metres.
Json posture_json(const RobotModel& robot, const std::vector<double>& configuration);

// A posture of a robot as a person reads it: joints by name, degrees and metres.
std::string describe_posture(const RobotModel& robot, const std::vector<double>& configuration);

// What touches in postures, as warnings: first where the meshes do, then where the spheres alone
// do. Of many of a kind the first, or the deepest, and how many more there are.
std::vector<std::string> contact_warnings(const std::vector<PostureContact>& contacts);

// Where a command learns of pairs of links; empty: not from there.
struct PairSources {
  std::string srdf;
  std::string pairs;    // NAME.pairs of `robot`
  bool proves = false;  // without that file: by proving

  bool is_empty() const { return srdf.empty() && pairs.empty(); }
};

// The pairs of a robot's links, told apart.
struct PairKinds {
  RobotModel model{""};  // with its spheres
  std::shared_ptr<const LinkPairs> proofs{};
  std::vector<PairStatus> pairs{};
  SrdfJudgement judgement{};  // of the SRDF, if there is one and proofs
};

// The pairs of the links that have spheres. What the SRDF disables and what the file of the spheres
// ignores is given, but for what either ignores because it was proved, where there are proofs; of
// both, what the robot has not got is passed over. Proves, where it does, on so many threads, 0:
// all. Throws Error as the readers do.
PairKinds pair_kinds(const RobotDescription& robot, const RobotSpheres& spheres,
                     LinkGeometry geometry, const PairSources& sources, int threads = 0);

// Of every pair its links, kind, verdict and share that is proved free; what is judged of an SRDF.
Json to_json(const PairKinds& kinds);

// Of this a count of each kind and a table of all pairs but those that are rigid or adjacent.
std::string describe_kinds(const Json& kinds);

}  // namespace spherule
