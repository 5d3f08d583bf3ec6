// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/robots/pair_report.h"
#include "cli/robots/robot_input.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/cover/robot_spheres.h"
#include "robot/pairs/srdf_judgement.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <map>
#include <memory>
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

// Bad news first.
std::string describe(const SrdfJudgement& judgement, const RobotModel& robot) {
  std::map<DisabledVerdict, std::size_t> count;
  std::size_t wrong_count = 0;
  std::string wrong;
  std::string decided;
  std::string open;
  for (const JudgedPair& judged : judgement.pairs) {
    ++count[judged.verdict];
    wrong_count += judged.is_wrong ? 1 : 0;
    const std::string pair = "  " + describe(judged.pair);
    if (judged.verdict == DisabledVerdict::kTouches) {
      (judged.is_wrong ? wrong : decided) +=
          pair + ": " + describe_posture(robot, judged.witness) + "\n";
    } else if (judged.verdict == DisabledVerdict::kUnknown) {
      open += pair;
      if (std::isfinite(judged.smallest_gap)) {
        open += ": " + number(judged.smallest_gap * kMillimetresPerMetre, 3) +
                " mm apart at the nearest posture found";
      }
      open += "\n";
    }
  }
  if (!wrong.empty()) {
    wrong = concat(wrong_count, " disabled ", wrong_count == 1 ? "pair touches" : "pairs touch",
                   ", though not meant to:\n", wrong);
  }
  if (!decided.empty()) {
    decided =
        "touching by somebody's decision (Default, Always, User, disable_default_collisions):\n" +
        decided;
  }
  if (!open.empty()) open = "neither proved nor touching:\n" + open;
  std::string addable;
  for (const auto& [first, second] : judgement.could_be_added) {
    addable += concat(addable.empty() ? "could be disabled, too (proved never to touch):\n" : "",
                      "  ", one_line(link_name(robot, first)), " and ",
                      one_line(link_name(robot, second)), "\n");
  }
  return concat(wrong, decided, open, judgement.pairs.size(),
                " disabled pairs: ", count[DisabledVerdict::kNever],
                " proved never to touch within the limits, ", count[DisabledVerdict::kAdjacent],
                " adjacent, ", count[DisabledVerdict::kRigid], " rigid, ",
                count[DisabledVerdict::kTouches], " touching, ", count[DisabledVerdict::kUnknown],
                " unknown, ", count[DisabledVerdict::kNoBody], " without geometry, ",
                count[DisabledVerdict::kOtherRobot], " of other robots\n", addable);
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
  for (const std::string& warning : semantics.warnings) warn(warning);
  if (semantics.disabled_pairs.empty() && semantics.links_disabled_by_default.empty()) {
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
  add_file_argument(*command, "urdf", arguments->urdf, "The robot, with its meshes");
  add_file_argument(*command, "srdf", arguments->srdf, "Its SRDF");
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
      {.text = "A pair is proved never to touch within the limits of the joints, by the meshes "
               "with their insides, or a posture is shown in which it does. The reasons Default, "
               "Always and User and the default of a link are decisions; every other one, and "
               "none, says that the links are "
               "apart, and touching is then wrong but for links that one joint joins, or none "
               "moves against each other.",
       .exit_codes = "0 every pair that is said to be apart, but for these, is proved never to "
                     "touch; 1 some touch, or nothing is proved of them",
       .examples = {"spherule check-srdf robot.urdf robot.srdf",
                    "spherule check-srdf robot.urdf robot.srdf --geometry visual --json"}}));
  command->callback([arguments, &exit_code] { exit_code = check_srdf(*arguments); });
}

}  // namespace spherule
