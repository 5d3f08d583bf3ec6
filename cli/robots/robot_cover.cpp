// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_cover.h"

#include "base/error.h"
#include "base/text.h"
#include "cli/files/files.h"
#include "cli/files/warnings.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/robots/pair_report.h"
#include "cli/robots/robot_input.h"
#include "cli/text/print.h"
#include "robot/model/joint_positions.h"
#include "robot/model/robot_model.h"
#include "simplifier/option_record.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

Json summary_of(const LinkCover& link) {
  Json json = Json::object();
  json["link"] = link.link;
  json["sphere_count"] = link.spheres.size();
  if (!link.fit) return json;
  const Simplification& fit = *link.fit;
  json["triangles"] = link.triangles;
  json["vertex_error"] = link.vertex_error;
  json["options"] = to_json(option_record(fit.options, 1.0));
  json["certificate"] = to_json(fit.certificate);
  json["warnings"] = link.warnings;
  if (fit.interrupted) json["interrupted"] = true;
  json["seconds"] = {{"external", fit.times.external},
                     {"cover", fit.times.cover},
                     {"certify", fit.times.certify},
                     {"total", link.seconds}};
  return json;
}

constexpr double kLitresPerCubicMetre = 1e3;
constexpr double kLargestRatio = 1e4;

// D of the links, and how much wider a way may be and still be filled.
std::string describe_filling(const RobotCover& cover) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto mm = [](double metres) { return decimal(metres * kMillimetresPerMetre, 1); };
  double least = kNone;
  double most = 0.0;
  double slack = 0.0;
  for (const LinkCover& link : cover.links) {
    if (!link.fit || link.triangles == 0) continue;  // spheres have nothing to fill
    const ExternalSpheres& external = link.fit->external;
    least = std::min(least, external.min_external_diameter);
    most = std::max(most, external.min_external_diameter);
    slack = std::max(slack, external.closing_slack / external.min_external_diameter);
  }
  if (least == kNone) return {};
  return "filled: what is narrower than D = " + mm(least) +
         (most > least ? " to " + mm(most) : "") +
         " mm (a smaller --min-external fills less); ways that are wider by " +
         decimal(100.0 * slack, 1) + " % stay open (proved)\n";
}

constexpr std::size_t kShownPairs = 5;
// Meshes nearer to each other than this part of the E of their links together touch, for spheres.
constexpr double kReallyClose = 1.0 / 16.0;

std::string millimetres(double length) {
  const double value = length * kMillimetresPerMetre;
  return decimal(value, value < 10.0 ? 1 : 0) + " mm";
}

Json counts_of(const FalseAlarms& alarms, const RobotModel& robot) {
  Json json = Json::object();
  json["postures"] = alarms.postures;
  json["free"] = alarms.free;
  json["proofs"] = name_of(alarms.proofs);
  json["refused"] = alarms.refused_share().refused;
  json["share"] = alarms.refused_share().share();
  for (const PairProofs proofs : {PairProofs::kNone, PairProofs::kNever, PairProofs::kBoxes}) {
    json["share_with_proofs"][std::string(name_of(proofs))] = alarms.refused_share(proofs).share();
  }
  json["always_touching"] = Json::array();
  for (const auto& [first, second] : alarms.always_touching) {
    json["always_touching"].push_back({link_name(robot, first), link_name(robot, second)});
  }
  json["pairs"] = Json::array();
  for (const PairAlarms& pair : alarms.pairs) {
    json["pairs"].push_back(
        {{"links", {link_name(robot, pair.first), link_name(robot, pair.second)}},
         {"refused", pair.refused},
         {"refused_alone", pair.refused_alone},
         {"median_gap", spherule::to_json(pair.median_gap)}});
  }
  return json;
}

double max_error_of(const RobotCover& cover, int link) {
  const auto& fit = cover.links[static_cast<std::size_t>(link)].fit;
  return fit ? fit->options.max_error : 0.0;
}

std::string remedy(const PairAlarms& pair, const RobotCover& cover) {
  const double errors = max_error_of(cover, pair.first) + max_error_of(cover, pair.second);
  if (pair.median_gap <= kReallyClose * errors) {
    return "really close: confirm contacts on meshes";
  }
  if (pair.median_gap >= errors) return "gaps are filled: a smaller D would spare half";
  return "E of " + millimetres(0.5 * pair.median_gap) + " on both would spare half";
}

// `json` is counts_of() them.
std::string describe_pairs(const FalseAlarms& alarms, const Json& json, const RobotCover& cover) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShownPairs, alarms.pairs.size()); ++i) {
    const PairAlarms& pair = alarms.pairs[i];
    const auto of_free = [&](std::size_t count) {
      return percent(RefusedShare{alarms.free, count}.share());
    };
    text += filled("  {links.0} and {links.1}: ", json["pairs"][i]) +
            concat(of_free(pair.refused), ", ", of_free(pair.refused_alone), " alone, meshes ",
                   millimetres(pair.median_gap), " apart; ", remedy(pair, cover), "\n");
  }
  if (alarms.pairs.size() > kShownPairs) {
    text += concat("  and ", alarms.pairs.size() - kShownPairs, " more pairs\n");
  }
  return text;
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
  add_file(command, "--poses", arguments.poses.file,
           "Postures, one a line, in which false alarms are counted, too (as the trajectories that "
           "check reads)");
  add_degrees_flag(command, "Angles of --poses are in degrees, lengths in metres", arguments.poses)
      ->needs("--poses");
  add_at_option(command, arguments.poses)->needs("--poses");
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
    poses_ = read_configurations(arguments.poses, robot).trajectory;
  }
  if (goal_ && robot.model.variable_count() == 0) {
    throw Error("--false-alarms", "the robot has no joint that moves");
  }
  if (goal_) blame_file("--false-alarms", [&] { require_limits(robot.model); });
}

// Of a pair's proof: in proportion to the effort of covers, but for a first part; all of it from
// the default effort on.
LinkPairOptions pair_options(const RobotCoverOptions& options) {
  constexpr int kFirstPart = 4;  // in units of effort
  const int whole = RobotCoverOptions{}.effort;
  const auto share = [&](std::size_t boxes) {
    return boxes * static_cast<std::size_t>(kFirstPart + std::min(options.effort, whole)) /
           static_cast<std::size_t>(kFirstPart + whole);
  };
  LinkPairOptions result;
  result.boxes = share(result.boxes);
  result.undecided_boxes = share(result.undecided_boxes);
  result.seed = options.seed;
  result.threads = options.threads;
  result.stop = options.stop;
  result.progress = options.progress;
  return result;
}

void FalseAlarmRun::prove(const RobotCoverOptions& options, MeasuredCover& result) const {
  if (proofs_ == PairProofs::kNone) return;
  const auto start = std::chrono::steady_clock::now();
  result.pairs = std::make_shared<const LinkPairs>(
      prove_link_pairs(robot_.model, result.bodies, pair_options(options)));
  result.pair_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.pairs_interrupted = options.stop.stop_requested();
}

void FalseAlarmRun::cover_to_goal(const RobotCoverOptions& options, bool has_max_error,
                                  std::span<const DisabledPair> disabled,
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

MeasuredCover FalseAlarmRun::cover(const RobotCoverOptions& options, bool has_max_error,
                                   std::span<const DisabledPair> disabled) const {
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
  // Random postures are drawn between limits.
  if (joint_without_limits(robot_.model) == nullptr) {
    result.random = measure_false_alarms(model, result.bodies, allowed, result.pairs.get(), sample);
  }
  result.upper_bound = result.random.refused_share().upper_bound(LinkErrorChoice::kConfidence);
  if (poses_.size() > 0) {
    result.given = measure_false_alarms(model, result.bodies, allowed, result.pairs.get(),
                                        poses_.positions, sample);
  }
  return result;
}

Json robot_summary(const std::string& urdf, const RobotCover& cover, double seconds) {
  std::size_t links = 0;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  bool covered = true;
  double depth = 0.0;
  double protrusion = 0.0;
  double over_mesh = 0.0;
  for (const LinkCover& link : cover.links) {
    if (!link.fit) continue;
    const Certificate& certificate = link.fit->certificate;
    ++links;
    triangles += link.triangles;
    spheres += link.spheres.size();
    covered = covered && certificate.covered;
    depth = std::max(depth, certificate.uncovered_depth.upper);
    protrusion = std::max(protrusion, certificate.protrusion_over_simplified_max.value_or(0.0));
    over_mesh = std::max(over_mesh, certificate.protrusion_over_mesh->upper);
  }
  Json json = Json::object();
  json["format"] = "spherule-robot-report";
  json["version"] = 1;
  json["urdf"] = urdf;
  json["robot"] = cover.robot;
  json["geometry"] = geometry_names()[cover.options.geometry == LinkGeometry::kCollision ? 0 : 1];
  json["total"] = {{"links", links},
                   {"triangles", triangles},
                   {"sphere_count", spheres},
                   {"covered", covered},
                   {"uncovered_depth_max", to_json(depth)},
                   {"protrusion_over_simplified_max", to_json(protrusion)},
                   {"protrusion_over_mesh_max", to_json(over_mesh)},
                   {"not_proved", links_not_proved(cover)},
                   {"seconds", seconds}};
  json["links"] = Json::array();
  for (const LinkCover& link : cover.links) json["links"].push_back(summary_of(link));
  return json;
}

Json robot_report(const Json& summary, const RobotCover& cover, ReportContent content) {
  Json json = summary;
  for (std::size_t i = 0; i < cover.links.size(); ++i) {
    if (!cover.links[i].fit) continue;
    json["links"][i]["simplified_solid"] = to_json(cover.links[i].fit->external, content);
  }
  return json;
}

std::string robot_table(const Json& summary, const RobotCover& cover) {
  const Json& total = summary["total"];
  Json rows = summary["links"];
  rows.push_back({{"link", "total"},
                  {"options", {{"max-error", cover.options.max_error}}},
                  {"triangles", total["triangles"]},
                  {"sphere_count", total["sphere_count"]},
                  {"certificate", total},
                  {"seconds", {{"total", total["seconds"]}}}});
  rows.back()["certificate"]["uncovered_depth"] = {0.0, total["uncovered_depth_max"]};
  for (Json& row : rows) {
    row.emplace("interrupted", false);
    if (!row.contains("certificate")) {
      row["options"]["max-error"] = filled("no {geometry} geometry", summary);
      continue;
    }
    const Json certificate = row["certificate"];
    // A depth that is proved to be none is shown as a bare 0; no other is.
    row["depth"] =
        certificate["covered"] == true ? "0" : filled("{uncovered_depth.1:mm3}", certificate);
    // An open mesh has no volume; this has next to none.
    const Json volume = certificate.value("volume_ratio", Json());
    row["volume"] = volume > kLargestRatio ? Json("> 1e4") : volume;
    const Json volume_filled = certificate.value("filled_volume", Json());
    if (volume_filled.is_number())
      row["filled"] = volume_filled.get<double>() * kLitresPerCubicMetre;
  }
  return table(rows, {{"link", "{link}"},
                      {"E/mm", "{options.max-error:mmf1}"},
                      {"triangles", "{triangles}"},
                      {"spheres", "{sphere_count}"},
                      {"uncovered/mm", "{depth}"},
                      {"protrusion/mm", "{certificate.protrusion_over_simplified_max:mmf2}"},
                      {"over mesh/mm", "{certificate.protrusion_over_mesh_max:mmf2}"},
                      {"volume", "{volume:f2}"},
                      {"filled/l", "{filled:f3}"},
                      {"seconds", "{seconds.total:f1}"},
                      {"", "{interrupted:*|}"}}) +
         (links_interrupted(cover).empty() ? "" : concat("* ", kInterruptedSearch, "\n")) +
         describe_filling(cover);
}

Json false_alarm_summary(const MeasuredCover& measured, const RobotModel& robot) {
  if (measured.random.postures == 0) return nullptr;
  Json json = counts_of(measured.random, robot);
  json["share_upper_bound"] = measured.upper_bound;
  json["confidence"] = LinkErrorChoice::kConfidence;
  if (measured.given.postures > 0) json["given"] = counts_of(measured.given, robot);
  if (!measured.choice) return json;
  const LinkErrorChoice& choice = *measured.choice;
  json["goal"] = {{"share", *measured.goal},
                  {"reached", choice.is_reached},
                  {"sphere_count", choice.spheres},
                  {"coarsest",
                   {{"max_error", measured.cover.options.max_error},
                    {"sphere_count", choice.coarsest_spheres},
                    {"share", choice.coarsest.refused_share().share()}}}};
  json["goal"]["links"] = Json::array();
  for (const ChosenError& link : choice.links) {
    json["goal"]["links"].push_back({{"link", link_name(robot, link.link)},
                                     {"max_error", link.max_error},
                                     {"sphere_count", link.spheres}});
  }
  return json;
}

std::string describe_false_alarms(const Json& json, const MeasuredCover& measured) {
  if (json.is_null()) return {};
  const FalseAlarms& alarms = measured.random;
  std::string text = filled(
      "false alarms: {share:%2} of {free} free postures (of {postures} random ones) are refused "
      "because of spheres, at most {share_upper_bound:%2} of all with {confidence:%0} confidence",
      json);
  const Json& share_with = json["share_with_proofs"];
  if (alarms.proofs != PairProofs::kNone) {
    text += filled("; {none:%2} where no pair is ignored", share_with);
  }
  if (alarms.proofs == PairProofs::kBoxes) {
    text += filled(
        ", {never:%2} where only pairs that never touch are ignored, as cuRobo and MoveIt do",
        share_with);
  }
  text += "\n";
  for (const Json& pair : json["always_touching"]) {
    text += filled(
        "  not counted: the meshes of {0} and {1} touch in all postures; disable the pair "
        "(--srdf)\n",
        pair);
  }
  if (measured.choice) {
    text +=
        filled(
            "  goal {share:%2}: {reached:reached|not reached} with {sphere_count} spheres; E of ",
            json["goal"]) +
        millimetres(measured.cover.options.max_error) +
        filled(" everywhere would take {sphere_count} and refuse {share:%2}\n",
               json["goal"]["coarsest"]);
    if (!measured.choice->is_reached && alarms.refused_share().share() <= *measured.goal) {
      text += "  so few postures do not show it: try more (--postures)\n";
    }
  }
  text += describe_pairs(alarms, json, measured.cover);
  if (!json.contains("given")) return text;
  return text +
         filled("  given postures: {share:%2} of {free} free ones (of {postures})\n",
                json["given"]) +
         describe_pairs(measured.given, json["given"], measured.cover);
}

}  // namespace spherule
