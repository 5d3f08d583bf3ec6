// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/options/options.h"
#include "cli/robots/trajectory.h"
#include "cli/text/json.h"
#include "robot/cover/goal_cover.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace spherule {

// What `spherule robot` is told about false alarms.
struct FalseAlarmArguments {
  std::string goal;  // empty: measure alone
  TrajectoryArguments poses;
  std::string proofs;
  std::size_t postures = 0;  // 0: the library's default, which is larger for a goal
};

// Adds the options that fill them.
void add_false_alarm_options(CLI::App& command, FalseAlarmArguments& arguments);

// The share that a text means, "1%" or "0.01". Throws Error for what is none between 0 and 1.
double share_of(const std::string& text);

// A robot's cover, what is proved of the pairs of its links, and its false alarms.
struct MeasuredCover {
  RobotCover cover;
  std::vector<LinkBody> bodies{};            // that are covered
  std::shared_ptr<const LinkPairs> pairs{};  // of these; null if none were to be proved
  double pair_seconds = 0.0;                 // that this took
  bool pairs_interrupted = false;            // a stop came before all pairs were examined
  std::optional<double> goal = std::nullopt;
  std::optional<LinkErrorChoice> choice = std::nullopt;  // if there is a goal
  FalseAlarms random{};      // of the cover; of no postures if not judged
  double upper_bound = 1.0;  // of its share, with LinkErrorChoice::kConfidence
  FalseAlarms given{};       // of no postures if none are given
};

// Covers a robot, to the goal if there is one (then with options.max_error as the coarsest E, where
// `has_max_error` says so), proves the pairs of its links and measures. Without a goal nothing is
// measured of a robot that has no joint to move.
class FalseAlarmRun {
 public:
  // Reads the postures and refuses what cannot be used, before long work is done.
  FalseAlarmRun(const FalseAlarmArguments& arguments, const RobotDescription& robot);

  // Pairs of links that are not tested stand in `disabled`.
  MeasuredCover cover(const RobotCoverOptions& options, bool has_max_error,
                      std::span<const DisabledPair> disabled) const;

 private:
  // Fills in what is proved of the bodies.
  void prove(const RobotCoverOptions& options, MeasuredCover& result) const;
  void cover_to_goal(const RobotCoverOptions& options, bool has_max_error,
                     std::span<const DisabledPair> disabled, const FalseAlarmOptions& sample,
                     MeasuredCover& result) const;

  const RobotDescription& robot_;
  std::optional<double> goal_;
  Trajectory poses_{};
  PairProofs proofs_;
  std::size_t postures_;
};

// What covering a robot came to, beside the spheres themselves: options, and a link the triangles,
// spheres, certificate, warnings and seconds; lengths in metres. `seconds` is for all of it.
Json robot_summary(const std::string& urdf, const RobotCover& cover, double seconds);

// What NAME.report.json holds: the summary, and of each link the simplified solid.
Json robot_report(const Json& summary, const RobotCover& cover, ReportContent content);

// The summary as a table for a person, lengths in millimetres.
std::string robot_table(const Json& summary, const RobotCover& cover);

// The false alarms of a cover, for the summary; null if none were counted. Lengths in metres.
Json false_alarm_summary(const MeasuredCover& measured, const RobotModel& robot);

// The same for a person, with the pairs that refuse most and what would mend them; empty if none
// were counted. Lengths in millimetres.
std::string describe_false_alarms(const Json& summary, const MeasuredCover& measured);

}  // namespace spherule
