// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/text.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/check_view.h"
#include "cli/pages/view_page.h"
#include "cli/robots/check_report.h"
#include "cli/robots/robot_input.h"
#include "cli/robots/trajectory.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/check/robot_checker.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/goal_cover.h"
#include "robot/files/robot_description.h"
#include "robot/model/joint_positions.h"
#include "robot/pairs/link_pairs.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// What --continuous takes.
constexpr const char* kAsGiven = "as-given";
constexpr const char* kShortest = "shortest";

struct CheckArguments {
  const CLI::App* command = nullptr;
  std::string urdf;
  std::string scene;
  TrajectoryArguments trajectory;
  std::string spheres;
  std::string pairs;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  RobotCoverOptions cover;
  double resolution = EdgeRequest{}.resolution;
  std::string continuous = kAsGiven;
  LengthOptions lengths;
  bool enforces_limits = false;
  bool ignores_unknown_links = false;
  bool json = false;
  std::string view;

  ContinuousMotion motion() const {
    return continuous == kAsGiven ? ContinuousMotion::kAsGiven : ContinuousMotion::kShortest;
  }
};

// Where bodies of the robot touch all the time: what to do about it, for a person.
std::string advice(const CheckArguments& arguments, const CheckReport& report) {
  const std::vector<TouchingPair> pairs = always_touching(report);
  if (pairs.empty()) return {};
  std::string text;
  for (const TouchingPair& pair : pairs) {
    text += one_line(pair.first.contact.first.name + " and " + pair.first.contact.second.name) +
            " touch all the time\n";
  }
  text +=
      "where they may, name them under \"allowed_contacts\" in " + one_line(arguments.scene) + "\n";
  if (!arguments.spheres.empty()) return text;  // how coarse they are is not known
  std::vector<std::string> finer = {"check", arguments.urdf, arguments.scene,
                                    arguments.trajectory.file};
  repeat(*arguments.command,
         {"--edges", "--continuous", "--degrees", "--at", "--enforce-limits", "--resolution",
          "--effort", "--pairs", "--geometry", "--package"},
         finer);
  finer.insert(finer.end(),
               {"--max-error", internal::number_text(0.5 * arguments.cover.max_error)});
  return text + describe({{std::move(finer), "finer spheres may part them"}});
}

// Of how many configurations of this shard, the first of the file, proofs are told of.
std::size_t explained_of(const TrajectoryInput& input) {
  constexpr std::size_t kMost = 10000;  // enough to see which pairs they are
  return std::min(input.own, kMost - std::min(kMost, input.first));
}

// What stands around the robot, and what is ignored.
PreparedScene prepare(SphereRobot robot, const SceneDescription& scene, RobotCoverOptions options) {
  ProgressBar bar;
  options.progress = bar.callback();
  PreparedScene prepared = prepare_scene(std::move(robot.model), scene, options, robot.ignored);
  bar.clear();
  for (const std::string& warning : prepared.warnings) warn(warning);
  return prepared;
}

// With --spheres no mesh is needed, unless proofs are about meshes.
RobotDescription read_checked_robot(const CheckArguments& arguments, LinkGeometry geometry) {
  const std::vector<LinkGeometry> needed(arguments.pairs.empty() ? 0 : 1, geometry);
  RobotDescription robot =
      arguments.spheres.empty()
          ? read_robot(arguments.urdf, arguments.packages, geometry)
          : read_urdf_with_warnings(arguments.urdf, arguments.packages, needed);
  if (robot.links.size() > AllowedCollisions::kMaxLinks) {
    throw Error(arguments.urdf, "has more than " + std::to_string(AllowedCollisions::kMaxLinks) +
                                    " links, too many to be checked");
  }
  return robot;
}

void write_checked(const CheckArguments& arguments, const CheckedScene& checked, bool has_motions) {
  ProgressBar bar;
  write_check_page(arguments.view, checked,
                   {.file = arguments.trajectory.file,
                    .has_motions = has_motions,
                    .continuous = arguments.motion(),
                    .threads = arguments.cover.threads,
                    .progress = bar.callback()});
  bar.clear();
}

// Names the first obstacle that only a scene in millimetres would have where it is.
void warn_of_far_obstacles(const std::string& file, const RobotScene& scene) {
  constexpr double kFar = 100.0;
  for (const std::string& name : scene.obstacles()) {
    const double away = scene.obstacle(name).world_from_shape.translation().norm();
    if (away <= kFar) continue;
    warn(file + ": obstacle " + name + " is " + std::to_string(std::lround(away)) +
         " m from the origin: lengths in scenes are metres; are these millimetres?");
    return;
  }
}

// What the files say.
struct CheckInput {
  RobotCoverOptions options;  // with the geometry
  RobotDescription robot;
  SceneDescription scene;
  TrajectoryInput trajectory;
  TurnReview turns;
};

CheckInput read_input(const CheckArguments& arguments) {
  require_resolution(arguments.resolution);
  RobotCoverOptions options = arguments.cover;
  options.geometry = geometry_named(arguments.geometry);
  RobotDescription robot = read_checked_robot(arguments, options.geometry);
  const RobotModel& model = robot.model;
  SceneDescription scene = read_scene(arguments.scene);
  TrajectoryInput input = read_configurations(arguments.trajectory, robot, scene.srdf.value_or(""));
  const Trajectory& trajectory = input.trajectory;
  if (arguments.enforces_limits) {
    blame_file("--enforce-limits", [&] { require_limits(model); });
  }
  if (!arguments.view.empty() && trajectory.size() == 0) {
    throw Error("--view", "there is nothing to show: this shard of the trajectory is empty");
  }
  TurnReview turns;
  if (arguments.trajectory.has_motions) {
    require_provable(model, arguments.trajectory, trajectory);
    if (input.has_motions) {
      turns =
          review_turns(arguments.urdf, arguments.trajectory, arguments.motion(), model, trajectory);
    }
    if (arguments.motion() == ContinuousMotion::kShortest) {
      require_provable(model, arguments.trajectory, ends_of_motions(model, trajectory));
    }
  }
  return {.options = std::move(options),
          .robot = std::move(robot),
          .scene = std::move(scene),
          .trajectory = std::move(input),
          .turns = std::move(turns)};
}

// What is queried.
struct CheckSetup {
  PreparedScene prepared;
  std::shared_ptr<const LinkPairs> proofs;  // if there are any
  bool is_whole;                            // no part of the robot was left out
};

CheckSetup set_up(const CheckArguments& arguments, const CheckInput& input) {
  if (arguments.spheres.empty()) {
    in_file(arguments.scene, [&] { check_scene_names(input.robot.model, input.scene); });
  }
  std::shared_ptr<const LinkPairs> proofs;
  if (!arguments.pairs.empty()) {
    proofs = std::make_shared<const LinkPairs>(load_link_pairs(
        arguments.pairs, input.robot.model, covered_bodies(input.robot, input.options)));
  }
  SphereRobot spheres =
      arguments.spheres.empty()
          ? cover_sphere_robot(arguments.urdf, input.robot, input.options)
          : read_sphere_robot(arguments.spheres, input.robot, input.options.geometry,
                              arguments.ignores_unknown_links);
  const bool is_whole = spheres.is_whole;
  CheckSetup setup{
      .prepared = in_file(arguments.scene,
                          [&] { return prepare(std::move(spheres), input.scene, input.options); }),
      .proofs = std::move(proofs),
      .is_whole = is_whole};
  warn_of_far_obstacles(arguments.scene, setup.prepared.scene);
  if (setup.proofs != nullptr) setup.prepared.scene.set_link_pairs(setup.proofs);
  return setup;
}

TrajectoryFindings check_trajectory(const CheckArguments& arguments, const CheckInput& input,
                                    const CheckSetup& setup, const RobotChecker& checker) {
  ProgressBar bar;
  const TrajectoryCheckOptions how{
      .explained = setup.proofs != nullptr ? explained_of(input.trajectory) : 0,
      .threads = input.options.threads,
      .progress = bar.callback(),
      .edge = {.resolution = arguments.resolution, .continuous = arguments.motion()},
      .configurations_in_all = input.trajectory.of};
  const Trajectory& trajectory = input.trajectory.trajectory;
  TrajectoryFindings found = input.trajectory.has_motions
                                 ? check_motions(checker, trajectory, how)
                                 : check_configurations(checker, trajectory, how);
  bar.clear();
  if (setup.proofs != nullptr) {
    const RobotModel& model = checker.robot();
    found.tell_kinds(model,
                     pair_statuses(model, setup.prepared.scene.allowed_collisions(), setup.proofs));
  }
  return found;
}

int check(const CheckArguments& arguments) {
  check_outputs({arguments.view}, {arguments.urdf, arguments.scene, arguments.trajectory.file,
                                   arguments.spheres, arguments.pairs});
  const CheckInput input = read_input(arguments);
  const CheckSetup setup = set_up(arguments, input);
  const RobotChecker checker =
      in_file(arguments.scene, [&] { return setup.prepared.scene.snapshot(); });
  const CheckReport report{.found = check_trajectory(arguments, input, setup, checker),
                           .configurations = input.trajectory.own,
                           .given_spheres = arguments.spheres,
                           .shard = arguments.trajectory.shard,
                           .is_whole = setup.is_whole,
                           .turns = input.turns,
                           .outside = input.trajectory.outside,
                           .enforces_limits = arguments.enforces_limits,
                           .is_in_degrees = arguments.trajectory.is_in_degrees};
  if (!arguments.view.empty()) {
    write_checked(arguments,
                  {.robot = input.robot,
                   .geometry = arguments.geometry,
                   .scene = input.scene,
                   .checker = checker,
                   .trajectory = input.trajectory.trajectory,
                   .report = report},
                  input.trajectory.has_motions);
  }
  const Json json = check_json(report);
  std::cout << (arguments.json ? to_text(json)
                               : check_table(report, json) + advice(arguments, report));
  if (!arguments.view.empty() && !arguments.json) std::cout << page_line(arguments.view);
  return report.is_free() ? kYes : kNo;
}

void add_files(CLI::App& command, CheckArguments& arguments) {
  add_file_argument(command, "urdf", arguments.urdf, "URDF of the robot");
  add_file_argument(command, "scene", arguments.scene, "Scene, JSON (docs/scene-file.md)");
  add_file_argument(command, "trajectory", arguments.trajectory.file,
                    "Configurations, one a line, with or without a line of joint names");
}

void add_motions(CLI::App& command, CheckArguments& arguments) {
  CLI::Option* edges = command.add_flag("--edges", arguments.trajectory.has_motions,
                                        "Prove every motion from one configuration to the next");
  command
      .add_option("--continuous", arguments.continuous,
                  "The way that continuous joints turn from one configuration to the next: "
                  "as-given, straight from number to number (default), or shortest, by at most "
                  "half a turn, as OMPL's SO2 goes")
      ->check(CLI::IsMember({kAsGiven, kShortest}))
      ->needs(edges);
  add_degrees_flag(command, "Angles of the trajectory are in degrees, lengths in metres",
                   arguments.trajectory);
  add_at_option(command, arguments.trajectory);
  command.add_flag("--enforce-limits", arguments.enforces_limits,
                   "Configurations outside the joint limits are not free (default: a warning)");
  add_shard_option(command,
                   "Only the I-th of N equal parts of the trajectory, for batch systems: counts of "
                   "all parts add up to those of the whole",
                   arguments.trajectory.shard);
  arguments.lengths
      .add(command, "--resolution", arguments.resolution,
           "How closely motions are examined, in metres (default 1e-4)")
      ->needs(edges);
}

void add_spheres(CLI::App& command, CheckArguments& arguments) {
  add_file(command, "--spheres", arguments.spheres,
           "Spheres of the robot, in any format that audit-robot reads, taken as they are: "
           "audit-robot proves whether they cover (default: cover the robot first)");
  add_unknown_links_flag(command, arguments.ignores_unknown_links);
  add_file(command, "--pairs", arguments.pairs,
           "What is proved of the pairs of the robot's links (NAME.pairs of robot, covered without "
           "padding): where two are proved free their spheres are not tested");
  arguments.lengths.add_positive(
      command, "--max-error", arguments.cover.max_error,
      "Without --spheres: how far spheres may protrude, in metres (default 0.01)");
  command
      .add_option("--effort", arguments.cover.effort,
                  "Without --spheres: how long to search for fewer spheres, as fit has it")
      ->check(check_not_negative);
  add_geometry_option(command, "Which of the robot's geometries stands for it (default: collision)",
                      arguments.geometry);
  add_package_option(command, arguments.packages);
  add_threads_option(command, arguments.cover.threads);
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Check a robot along a trajectory in a scene; exit 0 free, 1 collision or not proved");
  auto arguments = std::make_shared<CheckArguments>();
  arguments->command = command;
  add_files(*command, *arguments);
  add_motions(*command, *arguments);
  add_spheres(*command, *arguments);
  command->add_flag("--json", arguments->json, "Print the result as JSON");
  add_file(*command, "--view", arguments->view,
           "Write a page that plays the trajectory in its scene, with verdicts, contacts and "
           "clearance (HTML, as view writes it)");
  command->footer(to_text(
      {.text = "",
       .exit_codes = "0 free; 1 a collision, not proved, a link without spheres, or with "
                     "--enforce-limits a configuration outside the joint limits",
       .examples = {
           "spherule check robot.urdf cell.json path.csv",
           "spherule check robot.urdf cell.json path.csv --edges --spheres robot.spheres.json "
           "--json",
           "spherule check robot.urdf cell.json path.csv --edges --view path.html",
           "spherule check robot.urdf cell.json path.csv --degrees --edges --continuous shortest",
           "spherule check robot.urdf cell.json path.csv --edges --json --shard 2/8"}}));
  command->callback([arguments, &exit_code] {
    arguments->lengths.convert(metres());
    exit_code = check(*arguments);
  });
}

}  // namespace spherule
