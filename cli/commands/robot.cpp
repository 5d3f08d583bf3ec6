// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/view_page.h"
#include "cli/pages/view_robot.h"
#include "cli/robots/pair_report.h"
#include "cli/robots/robot_cover.h"
#include "cli/robots/robot_files.h"
#include "cli/robots/robot_input.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/check/robot_collision.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/robot_description.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "simplifier/simplify.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// What the command `robot` is given.
struct RobotArguments {
  const CLI::App* command = nullptr;
  std::string urdf;
  std::string folder;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  std::vector<std::string> links;
  std::vector<std::string> formats = robot_format_names();
  std::string srdf;
  std::string curobo;
  std::string xrdf;
  std::string tool_link;
  bool json = false;
  std::string view;
  ReportContent report_content = ReportContent::kNoExternalSpheres;
  FalseAlarmArguments false_alarms;
  RobotCoverOptions options;
  LengthOptions lengths;
};

void add_cover_options(CLI::App& command, RobotArguments& arguments) {
  add_file_argument(command, "urdf", arguments.urdf,
                    "The robot (URDF, or .xacro where the program xacro is found)");
  command
      .add_option("-o,--output", arguments.folder,
                  "Folder for what is written; it is made if it is not there (default: "
                  "NAME-spheres, here, where the URDF is NAME.urdf)")
      ->type_name(kFolder);
  arguments.lengths.add_positive(command, "--max-error", arguments.options.max_error,
                                 "E in metres, how far the spheres may protrude (default: 0.01)");
  arguments.lengths.add(command, "--min-external", arguments.options.min_external_diameter,
                        "D in metres, diameter of the smallest object to be checked against the "
                        "robot (default: 4 E, or more for links that are very large for their E)");
  command
      .add_option("--tightness", arguments.options.tightness,
                  "How much wider than D a way into a link may be and still be filled, as a share "
                  "of D (default: 0.03)")
      ->check(CLI::Range(0.001, ExternalOptions::kNoTightness));
  arguments.lengths.add(command, "--padding", arguments.options.padding,
                        "Grow every link by so many metres");
  arguments.lengths.add(command, "--weld", arguments.options.weld,
                        "Join vertices that are no further apart, in metres, so that cracks which "
                        "rounding has left do not open meshes; added to the padding");
}

void add_link_options(CLI::App& command, RobotArguments& arguments) {
  add_geometry_option(command, "What is covered: collision (default) or visual geometry",
                      arguments.geometry);
  add_package_option(command, arguments.packages);
  command
      .add_option("--link", arguments.links,
                  "What is other for one link, of max-error=E,min-external=D,padding=T,zones=FILE; "
                  "may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME:max-error=E,...");
  command
      .add_option("--format", arguments.formats,
                  "What is written, with commas between (default: all)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(robot_format_names()));
}

// Files of which what does not concern the spheres is kept.
void add_kept_files(CLI::App& command, RobotArguments& arguments) {
  add_file(command, "--srdf", arguments.srdf,
           "The robot's SRDF: its disabled pairs are ignored; all but its spheres is kept, and "
           "pairs that need no test are added");
  add_file(command, "--curobo", arguments.curobo,
           "The robot's cuRobo file, of which all but the spheres is kept; pairs that need no test "
           "are added");
  add_file(
      command, "--xrdf", arguments.xrdf,
      "The robot's XRDF, of which all but the spheres is kept; pairs that need no test are added");
  command
      .add_option("--tool-link", arguments.tool_link,
                  "The tool's link in new cuRobo and XRDF files (default: where the chain of "
                  "joints ends or branches)")
      ->type_name("LINK");
}

// Adds them to the command, which they have to outlive.
void add_robot_options(CLI::App& command, RobotArguments& arguments) {
  add_cover_options(command, arguments);
  add_link_options(command, arguments);
  add_kept_files(command, arguments);
  add_false_alarm_options(command, arguments.false_alarms);
  RobotCoverOptions& options = arguments.options;
  add_search_options(command, {options.seed, options.effort, options.seconds, options.threads},
                     "Rounds at most of searching for fewer spheres than at first, for each link, "
                     "fewer where more would not pay; 0: none",
                     "Search for fewer spheres for so long, for each link, less where it no longer "
                     "finds any; the result then depends on the machine");
  add_external_spheres_flag(command, arguments.report_content);
  command.add_flag("--json", arguments.json, "Print the summary as JSON, lengths in metres");
  add_file(command, "--view", arguments.view,
           "Write a page that shows the robot and its spheres (HTML, as view writes it)");
}

namespace fs = std::filesystem;

RobotFilePlan plan_of(const RobotArguments& arguments) {
  RobotFilePlan plan{.folder = arguments.folder,
                     .urdf = arguments.urdf,
                     .formats = arguments.formats,
                     .srdf = arguments.srdf,
                     .curobo = arguments.curobo,
                     .xrdf = arguments.xrdf,
                     .tool_link = arguments.tool_link};
  std::sort(plan.formats.begin(), plan.formats.end());
  plan.formats.erase(std::unique(plan.formats.begin(), plan.formats.end()), plan.formats.end());
  return plan;
}

// Refuses places that cannot be written, before long work is done for nothing. A folder that is not
// there is made, but only once there is something to put into it.
void check_places(const RobotArguments& arguments, std::vector<fs::path> outputs) {
  std::vector<fs::path> inputs = zone_files(arguments.links);
  inputs.insert(inputs.end(), {arguments.urdf, arguments.srdf, arguments.curobo, arguments.xrdf,
                               arguments.false_alarms.poses.file});
  std::error_code fault;
  if (fs::exists(arguments.folder, fault)) {
    if (!fs::is_directory(arguments.folder, fault)) {
      throw Error(arguments.folder, "is not a folder");
    }
    outputs.emplace_back(arguments.view);
    check_outputs(outputs, inputs);
  } else {
    check_outputs({arguments.folder, arguments.view}, inputs);
  }
}

// What is false is not handed on to other files as a reason.
std::vector<DisabledPair> without_refuted_reasons(std::vector<DisabledPair> pairs,
                                                  const SrdfJudgement& judgement) {
  for (DisabledPair& pair : pairs) {
    const bool is_wrong =
        std::any_of(judgement.pairs.begin(), judgement.pairs.end(), [&](const JudgedPair& judged) {
          return judged.is_wrong && judged.pair.link_a == pair.link_a &&
                 judged.pair.link_b == pair.link_b;
        });
    if (is_wrong) pair.reason = "given, though they can touch";
  }
  return pairs;
}

std::vector<std::string> links_to_cover(const RobotDescription& robot, LinkGeometry geometry) {
  std::vector<std::string> names;
  for (const LinkDescription& link : robot.links) {
    if (!link_shapes(link, geometry).empty()) names.push_back(link.name);
  }
  return names;
}

// Whether the links are as other commands read them: neither padded nor welded.
bool has_plain_links(const RobotArguments& arguments) {
  const auto links = link_options(arguments.links);
  return arguments.options.padding == 0.0 && arguments.options.weld == 0.0 &&
         std::none_of(links.begin(), links.end(),
                      [](const auto& link) { return link.second.padding.value_or(0.0) > 0.0; });
}

// With the file of all links that the other commands read, if it was requested.
std::vector<NextStep> next_steps(const RobotArguments& arguments,
                                 const std::vector<fs::path>& written) {
  const auto spheres = std::find_if(written.begin(), written.end(), [](const fs::path& file) {
    return file.string().ends_with(".spheres.json");
  });
  if (spheres == written.end()) return {};
  std::vector<std::string> view = {"view", arguments.urdf, spheres->string()};
  std::vector<std::string> check = {"check",    arguments.urdf, "SCENE.json",
                                    "PATH.csv", "--spheres",    spheres->string()};
  const auto pairs = std::find_if(written.begin(), written.end(), [](const fs::path& file) {
    return file.extension() == ".pairs";
  });
  // Proofs of other links are not those that these take.
  if (pairs != written.end() && has_plain_links(arguments)) {
    view.push_back(pairs->string());
    check.insert(check.end(), {"--pairs", pairs->string()});
  }
  view.insert(view.end(), {"-o", beside(spheres->string(), ".html")});
  for (std::vector<std::string>* step : {&view, &check}) {
    repeat(*arguments.command, {"--geometry", "--package"}, *step);
  }
  return {{std::move(view), "examine them"}, {std::move(check), "check a program"}};
}

// By the spheres and the lists of ignored pairs that are written.
std::vector<PostureContact> contacts_in_postures(const RobotDescription& robot,
                                                 const SemanticDescription& semantics,
                                                 const RobotSpheres& spheres,
                                                 const MeasuredCover& measured) {
  const RobotModel model = with_spheres(robot.model, spheres.links);
  AllowedCollisions allowed(model);
  allowed.allow(spheres.self_collision_ignore);
  allowed.apply(semantics);
  std::vector<NamedPosture> postures = group_postures(model, semantics);
  postures.insert(postures.begin(), zero_posture(model));
  return contacts_in(postures, model, measured.bodies, allowed, measured.pairs);
}

// Whether all that was promised holds; says on standard error what does not.
bool keeps_promises(const std::string& urdf, const MeasuredCover& result) {
  const std::vector<std::string> open = links_not_proved(result.cover);
  if (!open.empty()) {
    std::string names;
    for (const std::string& link : open) names += " " + link;
    tell(urdf + ": not proved for" + names);
  }
  const bool is_reached = !result.choice || result.choice->is_reached;
  if (!is_reached) tell(urdf + ": the share of false alarms is not reached");
  return open.empty() && is_reached;
}

void require_proofs_of_pairs(const RobotArguments& arguments, const RobotFilePlan& plan) {
  const bool wants_pairs =
      std::find(plan.formats.begin(), plan.formats.end(), kPairsFormat) != plan.formats.end();
  if (wants_pairs && plan.formats.size() < robot_format_names().size() &&
      arguments.false_alarms.proofs == name_of(PairProofs::kNone)) {
    throw Error("--format pairs", "nothing is proved of pairs with --proofs none");
  }
}

// With the pairs that need no test.
RobotSpheres spheres_to_write(const RobotDescription& robot, const MeasuredCover& measured,
                              const SemanticDescription& semantics,
                              const std::vector<DisabledPair>& disabled,
                              const SrdfJudgement& judgement) {
  RobotSpheres spheres = robot_spheres(robot, measured.cover);
  for (const auto& enabled : enabled_only(semantics)) {
    std::erase_if(spheres.self_collision_ignore, [&](const DisabledPair& pair) {
      return std::minmax(pair.link_a, pair.link_b) == std::minmax(enabled.first, enabled.second);
    });
  }
  if (measured.pairs != nullptr) {
    add_missing_pairs(pairs_proved_never(robot.model, *measured.pairs), robot.model,
                      spheres.self_collision_ignore);
  }
  add_missing_pairs(without_refuted_reasons(disabled, judgement), robot.model,
                    spheres.self_collision_ignore);
  return spheres;
}

Json summary_of(const std::string& urdf, const RobotModel& model, const MeasuredCover& measured,
                double seconds, const std::vector<PostureContact>& contacts,
                const SrdfJudgement& judgement) {
  Json summary = robot_summary(urdf, measured.cover, seconds);
  if (measured.pairs != nullptr) {
    summary["link_pairs"] = pair_summary(*measured.pairs, model, measured.pair_seconds);
    if (measured.pairs_interrupted) summary["link_pairs"]["interrupted"] = true;
  }
  if (measured.pairs_interrupted || !links_interrupted(measured.cover).empty()) {
    summary["interrupted"] = true;
  }
  summary["false_alarms"] = false_alarm_summary(measured, model);
  summary["posture_contacts"] = to_json(contacts);
  if (!judgement.pairs.empty()) summary["disabled_pairs"] = Json::array();
  for (const JudgedPair& judged : judgement.pairs) {
    summary["disabled_pairs"].push_back(to_json(judged, model));
  }
  return summary;
}

std::string describe(const Json& summary, const MeasuredCover& measured) {
  std::string text = robot_table(summary, measured.cover);
  if (measured.pairs != nullptr) text += describe_link_pairs(summary["link_pairs"]);
  if (measured.pairs_interrupted) {
    text += "pairs of links: the search for proofs was interrupted; what is unknown stays tested\n";
  }
  return text + describe_false_alarms(summary["false_alarms"], measured);
}

void print_warnings(const RobotCover& cover, LinkWarnings& of_links,
                    const std::vector<std::string>& wrong_pairs,
                    const std::vector<PostureContact>& contacts) {
  for (const LinkCover& link : cover.links) of_links.print(link.link, link.warnings);
  for (const std::string& warning : wrong_pairs) warn(warning);
  for (const std::string& warning : contact_warnings(contacts)) warn(warning);
}

// Fails (kNo), naming the links, if something promised of a link is not proved, or if the share of
// false alarms that is requested is not reached; the files are written nevertheless and say so.
int cover_links(RobotArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  if (arguments.folder.empty()) {
    fs::path name = fs::path(arguments.urdf).stem();
    if (name.extension() == ".urdf") name = name.stem();  // of NAME.urdf.xacro
    arguments.folder = name.string() + "-spheres";
  }
  RobotCoverOptions options = arguments.options;
  options.geometry = geometry_named(arguments.geometry);
  options.links = link_options(arguments.links);
  RobotFilePlan plan = plan_of(arguments);
  require_proofs_of_pairs(arguments, plan);
  const RobotDescription robot = read_robot(arguments.urdf, arguments.packages, options.geometry);
  if (!plan.tool_link.empty() && robot.model.find_link(plan.tool_link) < 0) {
    throw Error("--tool-link", "the robot has no link '" + plan.tool_link + "'");
  }
  const std::vector<std::string> links = links_to_cover(robot, options.geometry);
  in_file(arguments.urdf, [&] { check_cover_options(robot, options); });
  const std::vector<fs::path> outputs =
      in_file(arguments.urdf, [&] { return plan.all(robot, links); });
  check_places(arguments, outputs);
  rehearse_robot_files(plan, robot, links);
  SemanticDescription semantics;  // a bad file is refused in time
  if (!arguments.srdf.empty()) semantics = read_srdf(arguments.srdf);
  for (const std::string& warning : semantics.warnings) warn(warning);
  std::vector<DisabledPair> disabled;
  add_missing_pairs(disabled_among(semantics, links), robot.model, disabled);
  const FalseAlarmRun run(arguments.false_alarms, robot);

  StopOnInterruption interruption;
  options.stop = interruption.token();
  // The first answers of all links are a matter of seconds; the search for a goal has none before
  // its end.
  if (arguments.false_alarms.goal.empty()) interruption.have_answer();
  LinkWarnings warnings;
  const MeasuredCover measured = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    options.on_doubt = warnings.on_doubt(bar);
    return in_file(arguments.urdf, [&] {
      return run.cover(options, arguments.command->count("--max-error") > 0, disabled);
    });
  }();
  const RobotCover& result = measured.cover;
  if (measured.pairs == nullptr) std::erase(plan.formats, kPairsFormat);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  SrdfJudgement judgement;
  if (measured.pairs != nullptr) judgement = judge_srdf(robot.model, semantics, *measured.pairs);
  const RobotSpheres spheres = spheres_to_write(robot, measured, semantics, disabled, judgement);
  const std::vector<PostureContact> contacts =
      contacts_in_postures(robot, semantics, spheres, measured);
  const Json summary =
      summary_of(arguments.urdf, robot.model, measured, seconds.count(), contacts, judgement);
  const Json report = robot_report(summary, result, arguments.report_content);
  write_uninterrupted([&] {
    write_robot_files(plan, robot, spheres, measured.pairs.get());
    write_file_atomically(plan.report(robot), to_text(report, Layout::kCompact));
  });

  std::cout << (arguments.json ? to_text(summary) : describe(summary, measured));
  if (!arguments.view.empty()) {
    write_page(arguments.view, covered_robot_scene(robot, arguments.geometry, spheres,
                                                   "spheres of " + robot.name, report));
    if (!arguments.json) std::cout << page_line(arguments.view);
  }
  print_warnings(result, warnings, wrong_pairs(judgement, robot.model), contacts);
  if (plan.names_xacro_for_curobo(robot)) {
    warn("urdf_path of the cuRobo file is " + arguments.urdf +
         ", which cuRobo cannot read: with --format urdf,curobo it is the URDF that is written");
  }
  if (!arguments.json) std::cout << describe(next_steps(arguments, plan.all(robot, links)));
  return keeps_promises(arguments.urdf, measured) ? kYes : kNo;
}

}  // namespace

void add_robot(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("robot", "Cover every link of a robot with spheres, with a proof");
  auto arguments = std::make_shared<RobotArguments>();
  arguments->command = command;
  add_robot_options(*command, *arguments);
  command->footer(to_text(
      {.text = "Lengths are in metres, as in the URDF, or have a unit of their own (5mm). Writes "
               "NAME.spheres.urdf, NAME.srdf, NAME.curobo.yml, NAME.xrdf, NAME.foam.json, "
               "NAME.spheres.json, NAME.LINK.tree, NAME.pairs and NAME.report.json, NAME being the "
               "robot's name.",
       .exit_codes = "0 proved for every link; 1 not proved for links that are named (the files "
                     "are written and say so), or the share of false alarms is not reached",
       .examples = {
           "spherule robot robot.urdf -o spheres",
           "spherule robot robot.urdf -o spheres --max-error 20mm --format curobo,tree",
           "spherule robot robot.urdf -o spheres --false-alarms 1%",
           "spherule robot robot.urdf -o spheres --geometry visual --link hand:max-error=5mm",
           "spherule robot robot.urdf -o spheres --package parts=../parts --srdf robot.srdf"}}));
  command->callback([arguments, &exit_code] {
    arguments->lengths.convert(metres());
    exit_code = cover_links(*arguments);
  });
}

}  // namespace spherule
