// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/text/json.h"
#include "robot/check/robot_collision.h"
#include "robot/cover/link_mesh.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/srdf_judgement.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

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

// A count of each kind and a table of all pairs but those that are rigid or adjacent.
std::string describe(const PairKinds& kinds);

// Of every pair its links, kind, verdict and share that is proved free; what is judged of an SRDF.
Json to_json(const PairKinds& kinds);

}  // namespace spherule
