// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/options/robot_options.h"
#include "cli/robots/pair_report.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/cover/link_mesh.h"
#include "robot/pairs/srdf_judgement.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct CheckSrdfArguments {
  std::string urdf;
  std::string srdf;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  LinkPairOptions options;
  bool json = false;
};

std::size_t count_of(const SrdfJudgement& judgement, DisabledVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(judgement.pairs.begin(), judgement.pairs.end(),
                    [&](const JudgedPair& judged) { return judged.verdict == verdict; }));
}

void describe_touching(const SrdfJudgement& judgement, const RobotModel& robot, bool is_wrong,
                       std::ostream& out) {
  for (const JudgedPair& judged : judgement.pairs) {
    if (judged.verdict != DisabledVerdict::kTouches || judged.is_wrong != is_wrong) continue;
    out << "  " << describe(judged.pair) << ": " << describe_posture(robot, judged.witness) << "\n";
  }
}

// Bad news first.
std::string describe(const SrdfJudgement& judgement, const RobotModel& robot) {
  const auto wrong = static_cast<std::size_t>(
      std::count_if(judgement.pairs.begin(), judgement.pairs.end(),
                    [](const JudgedPair& judged) { return judged.is_wrong; }));
  std::ostringstream out;
  if (wrong > 0) {
    out << wrong << " disabled " << (wrong == 1 ? "pair touches" : "pairs touch")
        << ", though not meant to:\n";
    describe_touching(judgement, robot, true, out);
  }
  if (count_of(judgement, DisabledVerdict::kTouches) > wrong) {
    out << "touching by somebody's decision (Default, Always, User):\n";
    describe_touching(judgement, robot, false, out);
  }
  if (count_of(judgement, DisabledVerdict::kUnknown) > 0) out << "neither proved nor touching:\n";
  for (const JudgedPair& judged : judgement.pairs) {
    if (judged.verdict != DisabledVerdict::kUnknown) continue;
    out << "  " << describe(judged.pair);
    if (std::isfinite(judged.smallest_gap)) {
      out << ": " << std::setprecision(3) << judged.smallest_gap * kMillimetresPerMetre
          << " mm apart at the nearest posture found";
    }
    out << "\n";
  }
  out << judgement.pairs.size()
      << " disabled pairs: " << count_of(judgement, DisabledVerdict::kNever)
      << " proved never to touch within the limits, "
      << count_of(judgement, DisabledVerdict::kAdjacent) << " adjacent, "
      << count_of(judgement, DisabledVerdict::kRigid) << " rigid, "
      << count_of(judgement, DisabledVerdict::kTouches) << " touching, "
      << count_of(judgement, DisabledVerdict::kUnknown) << " unknown, "
      << count_of(judgement, DisabledVerdict::kNoBody) << " without geometry, "
      << count_of(judgement, DisabledVerdict::kOtherRobot) << " of other robots\n";
  if (!judgement.could_be_added.empty()) {
    out << "could be disabled, too (proved never to touch):\n";
  }
  for (const auto& [first, second] : judgement.could_be_added) {
    out << "  " << one_line(link_name(robot, first)) << " and "
        << one_line(link_name(robot, second)) << "\n";
  }
  return out.str();
}

Json judgement_json(const SrdfJudgement& judgement, const RobotModel& robot) {
  Json json = Json::object();
  json["format"] = "spherule-srdf-check";
  json["version"] = 1;
  json["pairs"] = Json::array();
  for (const JudgedPair& judged : judgement.pairs) json["pairs"].push_back(to_json(judged, robot));
  json["could_be_added"] = Json::array();
  for (const auto& [first, second] : judgement.could_be_added) {
    json["could_be_added"].push_back({link_name(robot, first), link_name(robot, second)});
  }
  return json;
}

int check_srdf(const CheckSrdfArguments& arguments) {
  const LinkGeometry geometry = geometry_named(arguments.geometry);
  const RobotDescription robot = read_robot(arguments.urdf, arguments.packages, geometry);
  const SemanticDescription semantics = read_srdf(arguments.srdf);
  if (semantics.disabled_pairs.empty()) {
    throw Error(arguments.srdf, "it disables no pair of links: is it an SRDF?");
  }
  const std::vector<LinkBody> bodies =
      in_file(arguments.urdf, [&] { return link_bodies(robot, {.geometry = geometry}); });
  const LinkPairs proofs = [&] {
    ProgressBar bar;
    LinkPairOptions options = arguments.options;
    options.progress = bar.callback();
    return prove_link_pairs(robot.model, bodies, options);
  }();
  const SrdfJudgement judgement = judge_srdf(robot.model, semantics, proofs);
  std::cout << (arguments.json ? to_text(judgement_json(judgement, robot.model))
                               : describe(judgement, robot.model));
  return std::any_of(judgement.pairs.begin(), judgement.pairs.end(),
                     [](const JudgedPair& judged) { return judged.is_wrong || judged.is_open; })
             ? kNo
             : kYes;
}

}  // namespace

void add_check_srdf(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "check-srdf",
      "Prove whether the pairs of links that an SRDF disables never touch; exit 0 proved, 1 not");
  auto arguments = std::make_shared<CheckSrdfArguments>();
  command->add_option("urdf", arguments->urdf, "The robot, with its meshes")
      ->required()
      ->type_name(kFile);
  command->add_option("srdf", arguments->srdf, "Its SRDF")->required()->type_name(kFile);
  add_geometry_option(*command, "Which of the robot's geometries is meant", arguments->geometry);
  add_package_option(*command, arguments->packages);
  command
      ->add_option("--seconds", arguments->options.seconds,
                   "Prove for so long at most; pairs that are left are unknown (default: no limit)")
      ->check(check_positive);
  add_threads_option(*command, arguments->options.threads,
                     "without --seconds the result is the same");
  command->add_flag("--json", arguments->json, "Print the verdicts as JSON");
  command->footer(to_text(
      {.text =
           "A pair is proved never to touch within the limits of the joints, by the meshes with "
           "their insides, or a posture is shown in which it does. The reasons Default, Always and "
           "User are decisions; every other one, and none, says that the links are apart, and "
           "touching is then wrong but for links that one joint joins, or none moves against each "
           "other.",
       .exit_codes = "0 every pair that is said to be apart, but for these, is proved never to "
                     "touch; 1 some touch, or nothing is proved of them",
       .examples = {"spherule check-srdf robot.urdf robot.srdf",
                    "spherule check-srdf robot.urdf robot.srdf --geometry visual --json"}}));
  command->callback([arguments, &exit_code] { exit_code = check_srdf(*arguments); });
}

}  // namespace spherule
