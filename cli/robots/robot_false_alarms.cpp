// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_false_alarms.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/help/help.h"
#include "robot/model/link_spheres.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

namespace spherule {
namespace {

const std::vector<std::string>& proof_names() {
  static const std::vector<std::string> names = {std::string(name_of(PairProofs::kBoxes)),
                                                 std::string(name_of(PairProofs::kNever)),
                                                 std::string(name_of(PairProofs::kNone))};
  return names;
}

PairProofs proofs_named(const std::string& name) {
  for (const PairProofs proofs : {PairProofs::kNone, PairProofs::kNever}) {
    if (name == name_of(proofs)) return proofs;
  }
  return PairProofs::kBoxes;
}

std::string check_share(const std::string& text) {
  try {
    share_of(text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

double share_of(const std::string& text) {
  const bool is_percent = text.ends_with('%');
  const std::optional<double> value =
      internal::finite_number(std::string_view(text).substr(0, text.size() - (is_percent ? 1 : 0)));
  const double share = value.value_or(0.0) / (is_percent ? 100.0 : 1.0);
  if (!(share > 0.0 && share < 1.0)) {
    throw Error(internal::in_quotes(text), "is no share between 0 and 1, as 1% or 0.01");
  }
  return share;
}

void add_false_alarm_options(CLI::App& command, FalseAlarmArguments& arguments) {
  arguments.proofs = proof_names().front();
  command
      .add_option("--false-alarms", arguments.goal,
                  "Choose E link by link for few spheres that refuse at most this share of the "
                  "free random postures, and of those of --poses (1% or 0.01); --max-error is then "
                  "the coarsest E (default: 0.04)")
      ->check(check_share)
      ->type_name("SHARE");
  command
      .add_option("--poses", arguments.poses.file,
                  "Postures, one a line, in which false alarms are counted, too (as the "
                  "trajectories that check reads)")
      ->type_name(kFile);
  add_degrees_flag(command, "Angles of --poses are in degrees, lengths in metres", arguments.poses)
      ->needs("--poses");
  command
      .add_option("--proofs", arguments.proofs,
                  "Which proofs about pairs of links spare tests where false alarms are counted: "
                  "boxes of joint positions (default), pairs that never touch, or none, and then "
                  "none are proved or written")
      ->check(CLI::IsMember(proof_names()));
  command
      .add_option("--postures", arguments.postures,
                  "Random postures in which false alarms are counted (default: 20000; with "
                  "--false-alarms 40000, and 200000 to verify the choice)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{std::numeric_limits<std::int32_t>::max()}));
}

FalseAlarmRun::FalseAlarmRun(const FalseAlarmArguments& arguments, const RobotDescription& robot)
    : robot_(robot), proofs_(proofs_named(arguments.proofs)), postures_(arguments.postures) {
  if (!arguments.goal.empty()) goal_ = share_of(arguments.goal);
  if (!arguments.poses.file.empty()) {
    poses_ = read_configurations(arguments.poses, robot.model).trajectory;
  }
  if (goal_ && robot.model.variable_count() == 0) {
    throw Error("--false-alarms", "the robot has no joint that moves");
  }
}

void FalseAlarmRun::prove(const RobotCoverOptions& options, MeasuredCover& result) const {
  if (proofs_ == PairProofs::kNone) return;
  const auto start = std::chrono::steady_clock::now();
  result.pairs =
      std::make_shared<const LinkPairs>(prove_link_pairs(robot_.model, result.bodies,
                                                         {.seed = options.seed,
                                                          .threads = options.threads,
                                                          .stop = options.stop,
                                                          .progress = options.progress}));
  result.pair_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.pairs_interrupted = options.stop.stop_requested();
}

void FalseAlarmRun::cover_to_goal(const RobotCoverOptions& options, bool has_max_error,
                                  const std::vector<std::pair<std::string, std::string>>& disabled,
                                  const FalseAlarmOptions& sample, MeasuredCover& result) const {
  LinkErrorOptions goal{.goal = *goal_, .given = poses_.positions, .sample = sample};
  if (has_max_error) {
    goal.finest_error *= options.max_error / goal.coarsest_error;
    goal.coarsest_error = options.max_error;
  }
  prove(options, result);
  GoalCover found =
      cover_robot_to_goal(robot_, result.bodies, disabled, result.pairs.get(), options, goal);
  result.cover = std::move(found.cover);
  result.goal = goal_;
  result.random = found.choice.verified;
  result.upper_bound = found.choice.upper_bound;
  result.given = found.choice.given;
  result.choice = std::move(found.choice);
}

MeasuredCover FalseAlarmRun::cover(
    const RobotCoverOptions& options, bool has_max_error,
    const std::vector<std::pair<std::string, std::string>>& disabled) const {
  const std::size_t usual =
      goal_ ? LinkErrorOptions{}.sample.postures : FalseAlarmOptions{}.postures;
  const FalseAlarmOptions sample{.postures = postures_ > 0 ? postures_ : usual,
                                 .seed = options.seed,
                                 .proofs = proofs_,
                                 .threads = options.threads,
                                 .progress = options.progress};
  MeasuredCover result;
  result.bodies = covered_bodies(robot_, options);
  if (goal_) {
    cover_to_goal(options, has_max_error, disabled, sample, result);
    return result;
  }
  result.cover = cover_robot(robot_, options);
  if (robot_.model.variable_count() == 0) return result;
  if (options.stop.stop_requested()) {
    result.pairs_interrupted = proofs_ != PairProofs::kNone;
    return result;
  }
  prove(options, result);
  const RobotModel model = with_spheres(robot_.model, robot_spheres(robot_, result.cover).links);
  if (options.stop.stop_requested()) return result;
  AllowedCollisions allowed(model);
  allowed.allow(disabled);
  result.random = measure_false_alarms(model, result.bodies, allowed, result.pairs.get(), sample);
  result.upper_bound = result.random.refused_share().upper_bound(LinkErrorChoice::kConfidence);
  if (poses_.size() > 0) {
    result.given = measure_false_alarms(model, result.bodies, allowed, result.pairs.get(),
                                        poses_.positions, sample);
  }
  return result;
}

}  // namespace spherule
