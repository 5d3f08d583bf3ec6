// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"
#include "cli/options/options.h"
#include "cli/robots/trajectory.h"
#include "cli/text/json.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_collision.h"
#include "robot/files/trajectory_file.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

// Where on a trajectory: a configuration, or a point of the motion from it to the next one.
struct TrajectoryPoint {
  std::size_t line = 0;     // of the file
  std::size_t to_line = 0;  // of the next configuration; 0 for the configuration itself
  double fraction = 0.0;    // of the motion
};

struct FoundContact {
  TrajectoryPoint at;
  CheckedContact contact;
};

// Two bodies, or a body and an obstacle, that touch somewhere.
struct TouchingPair {
  std::size_t count = 0;     // of configurations or motions
  std::size_t at_start = 0;  // of these, where nothing before the contact is free
  FoundContact first;        // on the trajectory
  FoundContact worst;        // the deepest that was found
  std::string kind{};        // of two links with proofs: what is known of them
};

// The verdicts one by one, of configurations or of motions.
struct TrajectoryVerdicts {
  std::vector<std::uint8_t> free{};   // of every configuration, 1 if it is free
  std::vector<EdgeResult> motions{};  // of every motion
};

// Builds a list of touching pairs, in the order of the first contacts.
class PairCounter {
 public:
  // Counts a configuration or motion in which a pair touches, at first and deepest there.
  void add(const FoundContact& first, const FoundContact& deepest);
  std::vector<TouchingPair> take() { return std::move(pairs_); }

 private:
  std::vector<TouchingPair> pairs_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;  // in the list, by names
};

// What was found along a trajectory, at configurations or on motions.
struct TrajectoryFindings {
  std::optional<std::size_t> motions{};       // where motions were proved
  std::size_t colliding = 0;                  // of the motions, or of the configurations
  std::vector<TrajectoryPoint> not_proved{};  // motions, and up to where they are free
  TrajectoryVerdicts verdicts{};
  std::vector<TouchingPair> pairs{};  // in the order of the first contacts
  // Whose spheres overlap while they are proved free, in the configurations that were examined.
  std::vector<TouchingPair> proved_free{};
  std::size_t explained = 0;  // configurations that were examined for these, the first ones

  // Says of the pairs of links of what kind they are.
  void tell_kinds(const RobotModel& robot, const std::vector<PairStatus>& statuses);
};

// What a check of a trajectory has to say.
struct CheckReport {
  TrajectoryFindings found{};
  std::size_t configurations = 0;

  // The file of spheres that were given: whether they cover the robot is not known. Empty for those
  // that were fitted, and so proved.
  std::string given_spheres{};

  Shard shard{};  // of the trajectory, that the report is about

  bool is_whole = true;  // no part of the robot was left out

  TurnReview turns{};
  OutsideLimits outside{};
  bool enforces_limits = false;
  bool is_in_degrees = false;  // what people are told

  bool is_out_of_bounds() const { return enforces_limits && outside.count > 0; }
  bool is_free() const {
    return found.colliding == 0 && found.not_proved.empty() && is_whole && !is_out_of_bounds();
  }
};

// "free", "collision", "not proved" or "outside limits".
const char* verdict_of(const CheckReport& report);

// Pairs of the robot's own bodies that touch in every configuration, or at the start of every
// motion, of two or more: their spheres may be too coarse, or they are meant to touch.
std::vector<TouchingPair> always_touching(const CheckReport& report);

// As JSON, and of this for a person a few lines and a table.
Json check_json(const CheckReport& report);
std::string check_table(const CheckReport& report, const Json& json);

struct TrajectoryCheckOptions {
  // In so many of the first configurations pairs that only proofs keep apart are counted, too.
  std::size_t explained = 0;
  int threads = 0;
  Progress progress{};
  EdgeRequest edge{};  // of motions
  // Of all parts of a trajectory together; 0: of what is given. How many places of a motion are
  // searched for contacts deeper than its first depends on it alone, so that each part finds what
  // the whole does.
  std::size_t configurations_in_all = 0;
};

// One for each thread: `threads` of them, or for 0 as many as the machine runs at once.
std::vector<RobotChecker::Scratch> make_scratches(const RobotChecker& checker, int threads);

// Every configuration, or every motion from one to the next.
TrajectoryFindings check_configurations(const RobotChecker& checker, const Trajectory& trajectory,
                                        const TrajectoryCheckOptions& options);
TrajectoryFindings check_motions(const RobotChecker& checker, const Trajectory& trajectory,
                                 const TrajectoryCheckOptions& options);

}  // namespace spherule
