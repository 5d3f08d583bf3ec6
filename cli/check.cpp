// SPDX-License-Identifier: BSD-3-Clause
#include "cli/check_report.h"
#include "cli/command.h"
#include "cli/command_specification.h"
#include "cli/help.h"
#include "cli/length_options.h"
#include "cli/next_step.h"
#include "cli/progress.h"
#include "cli/robot_options.h"
#include "cli/sphere_input.h"
#include "robot/check/robot_checker.h"
#include "robot/check/scene_setup.h"
#include "robot/cover/goal_cover.h"
#include "robot/files/trajectory_file.h"
#include "robot/files/urdf.h"
#include "robot/formats/sphere_formats.h"
#include "robot/model/link_spheres.h"
#include "robot/pairs/link_pairs_file.h"
#include "spheretree/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace spherule {
namespace {

struct CheckArguments {
  std::string urdf;
  std::string scene;
  std::string trajectory;
  std::string spheres;
  std::string pairs;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  RobotCoverOptions cover;
  double resolution = EdgeRequest{}.resolution;
  LengthOptions lengths;
  bool edges = false;
  bool json = false;
};

void warn(const std::string& what) {
  std::cerr << "spherule: warning: " << what << "\n";
}

// What a robot is made of for this check, and pairs of links that its spheres' file leaves out.
struct SphereRobot {
  RobotModel model;
  std::vector<DisabledPair> ignored;
  bool is_whole = true;  // every shape that was read stands in spheres
};

// Whether there are none: links that have a shape and no sphere, which would be free everywhere.
bool has_no_bare_links(const RobotDescription& robot, const RobotModel& model,
                       LinkGeometry geometry) {
  bool none = true;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    if (model.links()[i].trees.empty() && !link_shapes(robot.links[i], geometry).empty()) {
      warn("link " + robot.links[i].name + " has a shape but no spheres: it is not checked");
      none = false;
    }
  }
  return none;
}

SphereRobot read_spheres(const CheckArguments& arguments, const RobotDescription& robot) {
  SphereFormatFile file = read_robot_spheres(arguments.spheres);
  // In which frame they are nobody says, and here nothing proves that they cover.
  if (is_of_one_mesh(file)) throw Error(arguments.spheres, kNameItsLink);
  RobotSpheres read = std::move(file.spheres);
  const auto warn_of = [&](std::size_t count, const char* what) {
    if (count > 0) warn(arguments.spheres + ": " + std::to_string(count) + what);
  };
  warn_of(read.other_shapes, " shapes are no spheres: they are not checked");
  warn_of(read.switched_off, " spheres are switched off: they are not checked");
  warn_of(read.self_collision_ignore.size(), " pairs of links are not tested against each other");
  if (read.collision_buffer != 0.0 || !read.collision_buffers.empty() ||
      !read.self_collision_buffer.empty()) {
    warn(arguments.spheres + ": its buffers are not added; name them as padding in the scene");
  }
  return {with_spheres(robot.model, read.links), std::move(read.self_collision_ignore),
          read.other_shapes == 0};
}

SphereRobot cover(const CheckArguments& arguments, const RobotDescription& robot,
                  RobotCoverOptions options) {
  const RobotCover covered = [&] {
    ProgressBar bar;
    options.progress = bar.callback();
    return cover_robot(robot, options);
  }();
  std::vector<LinkSpheres> spheres;
  for (const LinkCover& link : covered.links) {
    if (link.fit && !link.fit->certificate.covered) {
      throw Error(arguments.urdf,
                  "link " + link.link + ": its spheres are not proved to cover all of it");
    }
    for (const std::string& warning : link.warnings) warn("link " + link.link + ": " + warning);
    spheres.push_back({link.link, link.spheres});
  }
  return {with_spheres(robot.model, spheres), {}, true};
}

// Motions are proved for positions up to that, in radians and metres.
constexpr double kLargestPosition = 100.0;

void require_provable(const Trajectory& trajectory, const std::string& file) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    for (const double position : trajectory.configuration(i)) {
      if (std::abs(position) <= kLargestPosition) continue;
      throw Error(file, "line " + std::to_string(trajectory.lines[i]) +
                            ": a position beyond 100, of which no motion is proved");
    }
  }
}

class TrajectoryCheck {
 public:
  // Where `has_proofs`, pairs that these alone keep apart are counted, too.
  TrajectoryCheck(const RobotChecker& checker, const Trajectory& trajectory, bool has_proofs,
                  int threads, Progress progress)
      : checker_(checker),
        trajectory_(trajectory),
        has_proofs_(has_proofs),
        progress_(std::move(progress)) {
    const unsigned count = threads > 0 ? static_cast<unsigned>(threads)
                                       : std::max(1u, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < count; ++i) scratches_.emplace_back(checker);
    report_.configurations = trajectory.size();
  }

  CheckReport configurations() && {
    std::vector<std::uint8_t> free(trajectory_.size());
    const std::span all(trajectory_.positions);
    in_blocks(free.size(), [&](std::size_t first, std::size_t count) {
      checker_.check_configs(all.subspan(first * trajectory_.width, count * trajectory_.width),
                             scratches_, std::span(free).subspan(first, count));
    });
    count_proved_free();
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i] != 0) continue;
      ++report_.colliding;
      explain(trajectory_.configuration(i), {.line = trajectory_.lines[i]});
    }
    return std::move(report_);
  }

  CheckReport motions(double resolution) && {
    const std::size_t count = trajectory_.size() - 1;
    const std::span all(trajectory_.positions);
    const std::size_t width = trajectory_.width;
    std::vector<EdgeResult> results;
    in_blocks(count, [&](std::size_t first, std::size_t edges) {
      const std::vector<EdgeResult> some =
          checker_.check_edges(all.subspan(first * width, edges * width),
                               all.subspan((first + 1) * width, edges * width), scratches_,
                               {.resolution = resolution, .first = true});
      results.insert(results.end(), some.begin(), some.end());
    });
    report_.motions = count;
    count_proved_free();
    for (std::size_t i = 0; i < count; ++i) {
      TrajectoryPoint at{.line = trajectory_.lines[i], .to_line = trajectory_.lines[i + 1]};
      if (results[i].verdict == Verdict::kCollision) {
        ++report_.colliding;
        at.fraction = results[i].contact_at;
        explain(between(i, at.fraction), at);
      } else if (results[i].verdict == Verdict::kUnknown) {
        at.fraction = results[i].free_until;
        report_.not_proved.push_back(at);
      }
    }
    return std::move(report_);
  }

 private:
  // So many at a time that the bar moves and the threads have enough to do.
  template <typename Check>
  void in_blocks(std::size_t count, Check check) const {
    const std::size_t block = std::max<std::size_t>(count / 50, 256);
    for (std::size_t first = 0; first < count; first += block) {
      if (progress_) {
        progress_(static_cast<double>(first) / static_cast<double>(count), "checking");
      }
      check(first, std::min(block, count - first));
    }
  }

  std::vector<double> between(std::size_t index, double fraction) const {
    const std::span<const double> from = trajectory_.configuration(index);
    const std::span<const double> to = trajectory_.configuration(index + 1);
    std::vector<double> result(from.begin(), from.end());
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += fraction * (to[k] - from[k]);
    return result;
  }

  void count_proved_free() {
    constexpr std::size_t kMost = 10000;  // enough to see which pairs they are
    if (!has_proofs_) return;
    report_.explained = std::min(kMost, trajectory_.size());
    for (std::size_t i = 0; i < report_.explained; ++i) {
      for (const CheckedContact& contact : checker_.explain(
               trajectory_.configuration(i), scratches_.front(), {.proved_free = true})) {
        if (contact.is_proved_free) report_.add({{.line = trajectory_.lines[i]}, contact});
      }
    }
  }

  void explain(std::span<const double> configuration, const TrajectoryPoint& at) {
    for (const CheckedContact& contact : checker_.explain(configuration, scratches_.front())) {
      report_.add({at, contact});
    }
  }

  const RobotChecker& checker_;
  const Trajectory& trajectory_;
  bool has_proofs_;
  Progress progress_;
  std::vector<RobotChecker::Scratch> scratches_;
  CheckReport report_;
};

// Where bodies of the robot touch all the time: what to do about it, for a person.
std::string advice(const CheckArguments& arguments, const CheckReport& report) {
  const std::vector<TouchingPair> pairs = always_touching(report);
  if (pairs.empty()) return {};
  std::string text;
  for (const TouchingPair& pair : pairs) {
    text += pair.first.contact.first.name + " and " + pair.first.contact.second.name +
            " touch all the time\n";
  }
  text += "where they may, name them under \"allowed_contacts\" in " + arguments.scene + "\n";
  if (!arguments.spheres.empty()) return text;  // how coarse they are is not known
  const CheckArguments defaults;
  std::vector<std::string> finer = {"check", arguments.urdf, arguments.scene, arguments.trajectory};
  if (arguments.edges) finer.push_back("--edges");
  if (arguments.resolution != defaults.resolution) {
    repeat("--resolution", arguments.resolution, finer);
  }
  repeat("--max-error", 0.5 * arguments.cover.max_error, finer);
  if (arguments.cover.effort != defaults.cover.effort) {
    repeat("--effort", std::to_string(arguments.cover.effort), finer);
  }
  if (!arguments.pairs.empty()) repeat("--pairs", arguments.pairs, finer);
  repeat_robot_options(arguments.geometry, arguments.packages, finer);
  return text + describe({{std::move(finer), "finer spheres may part them"}});
}

int check(const CheckArguments& arguments) {
  RobotCoverOptions options = arguments.cover;
  options.geometry = geometry_named(arguments.geometry);
  const RobotDescription robot = read_urdf(arguments.urdf, urdf_options(arguments.packages));
  const SceneDescription scene = read_scene(arguments.scene);
  const Trajectory trajectory = read_trajectory(arguments.trajectory, robot.model);
  if (arguments.edges) require_provable(trajectory, arguments.trajectory);
  require_resolution(arguments.resolution);

  SphereRobot spheres =
      arguments.spheres.empty() ? cover(arguments, robot, options) : read_spheres(arguments, robot);
  const bool is_whole =
      has_no_bare_links(robot, spheres.model, options.geometry) && spheres.is_whole;
  ProgressBar bar;
  options.progress = bar.callback();
  PreparedScene prepared = prepare_scene(std::move(spheres.model), scene, options);
  bar.clear();
  for (const std::string& warning : prepared.warnings) warn(warning);
  AllowedCollisions allowed = prepared.scene.allowed_collisions();
  for (const DisabledPair& pair : spheres.ignored) allowed.allow(pair.link_a, pair.link_b);
  prepared.scene.set_allowed_collisions(std::move(allowed));
  std::shared_ptr<const LinkPairs> proofs;
  if (!arguments.pairs.empty()) {
    proofs = std::make_shared<const LinkPairs>(
        load_link_pairs(arguments.pairs, robot.model, covered_bodies(robot, options)));
    prepared.scene.set_link_pairs(proofs);
  }

  const RobotChecker checker = prepared.scene.snapshot();
  TrajectoryCheck trajectory_check(checker, trajectory, proofs != nullptr, options.threads,
                                   bar.callback());
  CheckReport report = arguments.edges && trajectory.size() > 1
                           ? std::move(trajectory_check).motions(arguments.resolution)
                           : std::move(trajectory_check).configurations();
  bar.clear();
  report.is_whole = is_whole;
  if (proofs != nullptr) {
    const RobotModel& model = checker.robot();
    report.tell_kinds(model, pair_statuses(model, prepared.scene.allowed_collisions(), proofs));
  }
  std::cout << (arguments.json ? check_json(report)
                               : check_table(report) + advice(arguments, report));
  return report.is_free() ? kYes : kNo;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Check a robot along a trajectory in a scene; exit 0 free, 1 collision or not proved");
  auto arguments = std::make_shared<CheckArguments>();
  command->add_option("urdf", arguments->urdf, "URDF of the robot")->required()->type_name(kFile);
  command->add_option("scene", arguments->scene, "Scene, JSON (docs/scene-file.md)")
      ->required()
      ->type_name(kFile);
  command
      ->add_option("trajectory", arguments->trajectory,
                   "Configurations, one a line, with or without a line of joint names")
      ->required()
      ->type_name(kFile);
  command->add_flag("--edges", arguments->edges,
                    "Prove every motion from one configuration to the next");
  arguments->lengths.add(
      *command, "--resolution", arguments->resolution,
      "With --edges: how closely motions are examined, in metres (default 1e-4)");
  command
      ->add_option("--spheres", arguments->spheres,
                   "Spheres of the robot, in any format that audit-robot reads (default: cover "
                   "the robot first)")
      ->type_name(kFile);
  command
      ->add_option("--pairs", arguments->pairs,
                   "What is proved of the pairs of the robot's links (NAME.pairs of robot, covered "
                   "without padding): where two are proved free their spheres are not tested")
      ->type_name(kFile);
  arguments->lengths.add_positive(
      *command, "--max-error", arguments->cover.max_error,
      "Without --spheres: how far spheres may protrude, in metres (default 0.01)");
  command
      ->add_option("--effort", arguments->cover.effort,
                   "Without --spheres: how long to search for fewer spheres, as fit has it")
      ->check(CLI::NonNegativeNumber);
  add_geometry_option(*command,
                      "Which of the robot's geometries stands for it (default: collision)",
                      arguments->geometry);
  add_package_option(*command, arguments->packages);
  command->add_option("--threads", arguments->cover.threads, "Threads, 0: all (default)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", arguments->json, "Print the result as JSON");
  command->footer(
      to_text({.text = "",
               .exit_codes = "0 free; 1 a collision, not proved, or a link without spheres",
               .examples = {"spherule check robot.urdf cell.json path.csv",
                            "spherule check robot.urdf cell.json path.csv --edges --spheres "
                            "robot.spheres.json --json"}}));
  command->callback([arguments, &exit_code] {
    arguments->lengths.convert(metres());
    exit_code = check(*arguments);
  });
}

}  // namespace spherule
