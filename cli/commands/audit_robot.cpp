// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/audit_robot.h"

#include "base/error.h"
#include "cli/commands/command.h"
#include "cli/files/files.h"
#include "cli/help/help.h"
#include "cli/options/options.h"
#include "cli/pages/view_page.h"
#include "cli/pages/view_robot.h"
#include "cli/robots/pair_report.h"
#include "cli/robots/robot_input.h"
#include "cli/robots/trajectory.h"
#include "cli/text/json.h"
#include "cli/text/print.h"
#include "cli/text/progress.h"
#include "robot/formats/sphere_formats.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// What `audit-robot` found, and what it did where it mended. Lengths in metres.
struct RobotAuditReport {
  SphereFormatFile file;
  RobotAudit audit;
  std::string repaired_file;  // where the mended spheres went; empty if nowhere
  std::optional<RobotRepair> repair;
  std::optional<PairKinds> pairs;  // if they were requested
};

Json json_of(const LinkAudit& link) {
  return {{"link", link.link},
          {"sphere_count", link.spheres},
          {"uncovered_share", link.uncovered_share},
          {"certificate", to_json(link.certificate)},
          {"warnings", link.warnings}};
}

Json audit_json(const RobotAuditReport& report) {
  Json json = Json::object();
  json["format"] = name_of(report.file.format);
  json["links_covered"] = report.audit.links_covered;
  json["links"] = Json::array();
  for (const LinkAudit& link : report.audit.links) json["links"].push_back(json_of(link));
  json["switched_off"] = report.file.spheres.switched_off;
  json["other_shapes"] = report.file.spheres.other_shapes;
  json["unknown_links"] = report.audit.unknown_links;
  if (!report.audit.configurations.empty()) {
    json["configurations_covered"] = report.audit.configurations_covered;
    json["configurations"] = Json::array();
    for (const ConfigurationAudit& configuration : report.audit.configurations) {
      json["configurations"].push_back({{"uncovered_depth", to_json(configuration.uncovered_depth)},
                                        {"deepest_link", configuration.deepest_link}});
      if (configuration.deepest_leak) {
        json["configurations"].back()["deepest_leak"] = to_json(*configuration.deepest_leak);
      }
    }
  }
  if (report.pairs) json.update(to_json(*report.pairs));
  if (!report.repair) return json;
  json["repair"] = {{"file", report.repaired_file}, {"links", Json::array()}};
  for (const LinkRepair& link : report.repair->links) {
    Json& repaired = json["repair"]["links"].emplace_back(Json{{"link", link.link}});
    repaired.update(to_json(link.repair));
    repaired["certificate"] = to_json(link.certificate);
    repaired["warnings"] = link.warnings;
  }
  return json;
}

// The worst of the links that have geometry, as a link of its own.
LinkAudit all_links(const std::vector<LinkAudit>& links) {
  LinkAudit all{.link = "all", .certificate = Certificate{}};
  all.certificate->covered = true;
  Bounds protrusion;
  const auto worsen = [](Bounds& worst, const Bounds& other) {
    worst = {std::max(worst.lower, other.lower), std::max(worst.upper, other.upper)};
  };
  for (const LinkAudit& link : links) {
    if (!link.certificate) continue;
    all.spheres += link.spheres;
    worsen(all.certificate->surface_depth, link.certificate->surface_depth);
    worsen(all.certificate->solid_depth, link.certificate->solid_depth);
    worsen(protrusion, *link.certificate->protrusion_over_mesh);
    all.certificate->covered = all.certificate->covered && link.certificate->covered;
  }
  all.certificate->protrusion_over_mesh = protrusion;
  return all;
}

// A table of the links, the configurations, the repair and the pairs of links, lengths in
// millimetres.
std::string audit_table(const RobotAuditReport& report, const Json& json) {
  Json rows = Json::array();
  Json leaking = Json::array();
  for (const Json& link : json["links"]) {
    if (link["certificate"].is_null() && link["sphere_count"] == 0) continue;
    rows.push_back(link);
    rows.back()["leak"] = filled("{certificate.uncovered_depth_surface:mm~}", link);
    if (link["certificate"].is_null()) {
      rows.back()["leak"] = "no geometry";
      rows.back()["uncovered_share"] = nullptr;
    } else if (!link["certificate"]["deepest_leak"].is_null()) {
      leaking.push_back(link);
    }
  }
  rows.push_back(json_of(all_links(report.audit.links)));
  rows.back()["leak"] = filled("{certificate.uncovered_depth_surface:mm~}", rows.back());
  rows.back()["uncovered_share"] = nullptr;
  std::string text = filled("{format}; lengths in mm\n", json) +
                     table(rows, {{"link", "{link}"},
                                  {"spheres", "{sphere_count}"},
                                  {"leak surface", "{leak}"},
                                  {"leak inside", "{certificate.uncovered_depth_solid:mm~}"},
                                  {"uncovered", "{uncovered_share:%1}"},
                                  {"protrusion", "{certificate.protrusion_over_mesh:mm~}"},
                                  {"covered", "{certificate.covered:yes|NO}"}});
  if (!leaking.empty()) {
    text += "deepest leaks at (x, y, z), in the frame of the link:\n" +
            table(leaking, {{"", "  {link}"}, {"", "({certificate.deepest_leak:mmf1})"}});
  }
  text += lines(json, {{"#switched_off", "left out: {} spheres that the file switches off\n"},
                       {"#other_shapes", "left out: {} collision shapes that are no spheres\n"}});
  for (const std::string& link : report.audit.unknown_links) {
    text += "left out: the spheres of " + one_line(link) + ", which is no link of the robot\n";
  }
  std::size_t number = 0;
  for (const Json& configuration : json.value("configurations", Json::array())) {
    text += "configuration " + std::to_string(++number) +
            lines(configuration, {{"!deepest_link", ": all links are covered (proved)\n"},
                                  {"deepest_link", ": leak {uncovered_depth:mm~}, at {}"},
                                  {"deepest_leak", ", ({:mmf1}) in the frame of the root"},
                                  {"deepest_link", "\n"}});
  }
  if (report.repair) {
    text += filled("repaired into {repair.file}\n", json);
    for (const Json& link : json["repair"]["links"]) {
      text += filled("  {link}: ", link) + describe_repair(link, "mm") +
              filled("; {certificate.covered:covered (proved)|NOT proved to cover}\n", link);
    }
  }
  return text + (report.pairs ? describe_kinds(json) : "");
}

struct AuditRobotArguments {
  const CLI::App* command = nullptr;
  std::string urdf;
  std::string spheres;
  std::string geometry = geometry_names().front();
  std::vector<std::string> packages;
  TrajectoryArguments poses;
  std::string link;
  std::optional<std::size_t> level;
  std::string repaired;
  PairSources pairs{.srdf = {}, .pairs = {}, .proves = true};
  bool ignores_unknown_links = false;
  std::optional<double> max_error;
  LengthOptions lengths;
  std::optional<double> min_external;
  int threads = 0;
  bool json = false;
  std::string view;
};

std::vector<std::vector<double>> configurations_of(const TrajectoryArguments& arguments,
                                                   const std::string& srdf,
                                                   const RobotDescription& robot) {
  std::vector<std::vector<double>> configurations;
  if (arguments.file.empty()) return configurations;
  const Trajectory trajectory = read_configurations(arguments, robot, srdf).trajectory;
  require_provable(robot.model, arguments, trajectory);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto positions = trajectory.configuration(i);
    configurations.emplace_back(positions.begin(), positions.end());
  }
  return configurations;
}

void check_repair(const AuditRobotArguments& arguments, const SphereFormatFile& file,
                  bool is_shrunk) {
  if (!is_written(file.format)) {
    throw Error(arguments.spheres,
                std::string(name_of(file.format)) + " is read only and cannot be repaired");
  }
  if (is_shrunk) throw Error(arguments.spheres, "spheres with a buffer below 0 are not repaired");
}

RobotSpheres repaired_spheres(const RobotAuditReport& report) {
  RobotSpheres spheres = report.file.spheres;
  spheres.links = report.repair->spheres;
  return spheres;
}

// In the format of the file, which is kept but for the spheres.
void write_repaired(const AuditRobotArguments& arguments, const RobotAuditReport& report) {
  write_robot_spheres(repaired_spheres(report), report.file.format,
                      {.urdf = arguments.spheres, .original = arguments.spheres},
                      arguments.repaired);
}

// Of the repaired spheres, where they were requested, otherwise of those audited with their leaks,
// which are in `json`.
ViewScene page_of(const AuditRobotArguments& arguments, const RobotDescription& robot,
                  const RobotAuditReport& report, const Json& json) {
  if (report.repair) {
    Json links = Json::array();
    for (const LinkRepair& link : report.repair->links) {
      links.push_back({{"link", link.link}, {"certificate", to_json(link.certificate)}});
    }
    return covered_robot_scene(robot, arguments.geometry, repaired_spheres(report),
                               arguments.repaired, {{"links", std::move(links)}});
  }
  return covered_robot_scene(robot, arguments.geometry, report.file.spheres, arguments.spheres,
                             json);
}

// `view` knows neither --link nor --level, and of files that name no link only those that cannot be
// a part's; --repair makes the links cover, not the configurations.
std::vector<NextStep> steps_after_leak(const AuditRobotArguments& arguments, bool names_links,
                                       bool is_mendable) {
  std::vector<NextStep> steps;
  const bool is_shown = names_links || is_robot_file(arguments.spheres);
  if (is_shown && arguments.link.empty() && !arguments.level) {
    std::vector<std::string> view = {"view", arguments.urdf, arguments.spheres};
    repeat(*arguments.command, {"--geometry", "--package"}, view);
    view.insert(view.end(), {"--leaks", "-o", here(arguments.spheres, ".html")});
    steps.push_back({std::move(view), "see where they leak"});
  }
  if (is_mendable && arguments.poses.file.empty()) {
    std::vector<std::string> mend = {"audit-robot", arguments.urdf, arguments.spheres};
    repeat(*arguments.command,
           {"--geometry", "--package", "--link", "--level", "--max-error", "--min-external"}, mend);
    const std::string ending = std::filesystem::path(arguments.spheres).extension().string();
    mend.insert(mend.end(), {"--repair", here(arguments.spheres, ".mended" + ending)});
    steps.push_back({std::move(mend), "make them cover"});
  }
  return steps;
}

bool has_shrinking_buffers(const RobotSpheres& spheres) {
  return spheres.collision_buffer < 0.0 ||
         std::any_of(spheres.collision_buffers.begin(), spheres.collision_buffers.end(),
                     [](const auto& buffer) { return buffer.second < 0.0; });
}

// What is audited, read and checked.
struct AuditInput {
  RobotDescription robot;
  SphereInput given;
  RobotAuditOptions options;
  bool is_shrunk;  // by buffers below 0

  const RobotSpheres& spheres() const { return given.file.spheres; }
};

// --link is for files that name no link.
void check_link(const AuditRobotArguments& arguments, const RobotModel& robot,
                const RobotSpheres& spheres) {
  const std::string& link = arguments.link;
  if (link.empty()) return;
  if (robot.find_link(link) < 0) throw Error("--link", "the robot has no link '" + link + "'");
  if (spheres.links.size() != 1 || spheres.links.front().link != link) {
    throw Error("--link", arguments.spheres + " names its links itself");
  }
}

AuditInput read_input(const AuditRobotArguments& arguments) {
  const LinkGeometry geometry = geometry_named(arguments.geometry);
  RobotDescription robot = read_robot(arguments.urdf, arguments.packages, geometry);
  SphereInput given = read_spheres_of(robot, geometry, arguments.spheres,
                                      {.link = arguments.link, .level = arguments.level});
  const RobotSpheres& spheres = given.file.spheres;
  check_link(arguments, robot.model, spheres);
  require_known_links(robot.model, arguments.spheres, spheres, arguments.ignores_unknown_links);
  // Bad files are refused before the work that they are for.
  if (!arguments.pairs.srdf.empty()) read_srdf(arguments.pairs.srdf);
  if (!arguments.pairs.pairs.empty()) {
    load_link_pairs(arguments.pairs.pairs, robot.model, link_bodies(robot, {.geometry = geometry}));
  }
  const bool is_shrunk = has_shrinking_buffers(spheres);
  if (!arguments.repaired.empty()) check_repair(arguments, given.file, is_shrunk);
  RobotAuditOptions options{
      .geometry = geometry,
      .min_external_diameter = arguments.min_external.value_or(0.0),
      .configurations = configurations_of(arguments.poses, arguments.pairs.srdf, robot),
      .threads = arguments.threads};
  if (arguments.max_error) options.max_error = *arguments.max_error;
  return {.robot = std::move(robot),
          .given = std::move(given),
          .options = std::move(options),
          .is_shrunk = is_shrunk};
}

// Certifies the spheres, and repairs them where that was requested.
RobotAuditReport audited(const AuditRobotArguments& arguments, const AuditInput& input) {
  RobotAuditReport report{.file = input.given.file,
                          .audit = {},
                          .repaired_file = arguments.repaired,
                          .repair = std::nullopt,
                          .pairs = std::nullopt};
  const RobotSpheres& spheres = input.spheres();
  {
    ProgressBar bar;
    RobotAuditOptions options = input.options;
    options.progress = bar.callback();
    const auto is_of_spheres = [](const Error& error) {
      return error.subject().find(", sphere ") != std::string::npos ||
             error.reason().starts_with("has a sphere");
    };
    const auto audit_and_repair = [&] {
      report.audit = audit_robot(input.robot, shrunk_by_buffers(spheres), options);
      if (arguments.repaired.empty()) return;
      report.repair = repair_robot(input.robot, spheres.links,
                                   {.geometry = options.geometry,
                                    .max_error = arguments.max_error.value_or(0.0),
                                    .threads = arguments.threads,
                                    .progress = options.progress});
    };
    in_file(arguments.urdf,
            [&] { blame_file_if(is_of_spheres, arguments.spheres, audit_and_repair); });
  }
  if (!arguments.pairs.is_empty()) {
    report.pairs = pair_kinds(input.robot, spheres, input.options.geometry, arguments.pairs,
                              arguments.threads);
  }
  return report;
}

void print(const AuditRobotArguments& arguments, const AuditInput& input,
           const RobotAuditReport& report) {
  const Json json = audit_json(report);
  std::cout << (arguments.json ? to_text(json) : audit_table(report, json));
  if (arguments.view.empty()) return;
  write_page(arguments.view, page_of(arguments, input.robot, report, json));
  if (!arguments.json) std::cout << page_line(arguments.view);
}

void warn_of(const AuditRobotArguments& arguments, const AuditInput& input,
             const RobotAuditReport& report) {
  LinkWarnings of_links;
  for (const LinkAudit& link : report.audit.links) of_links.print(link.link, link.warnings);
  if (report.repair) {
    for (const LinkRepair& link : report.repair->links) of_links.print(link.link, link.warnings);
  }
  if (report.pairs) {
    for (const std::string& warning : wrong_pairs(report.pairs->judgement, input.robot.model)) {
      warn(warning);
    }
  }
  if (input.is_shrunk) {
    tell(arguments.spheres + ": spheres were certified as its buffers below 0 shrink them");
  }
}

// Of the repaired spheres, where they were requested.
bool is_covered(const AuditRobotArguments& arguments, const RobotAuditReport& report) {
  if (report.repair) {
    return std::ranges::all_of(report.repair->links,
                               [](const LinkRepair& link) { return link.certificate.covered; });
  }
  return arguments.poses.file.empty() ? report.audit.links_covered
                                      : report.audit.configurations_covered;
}

int audit(const AuditRobotArguments& arguments) {
  check_outputs({arguments.repaired, arguments.view},
                {arguments.urdf, arguments.spheres, arguments.poses.file, arguments.pairs.srdf,
                 arguments.pairs.pairs});
  const AuditInput input = read_input(arguments);
  const RobotAuditReport report = audited(arguments, input);
  if (report.repair) {
    write_uninterrupted([&] { write_repaired(arguments, report); });
  }
  print(arguments, input, report);
  warn_of(arguments, input, report);
  if (is_covered(arguments, report)) return kYes;
  if (!report.repair && !arguments.json) {
    const bool is_mendable = is_written(report.file.format) && !input.is_shrunk;
    std::cout << describe(steps_after_leak(arguments, input.given.names_links, is_mendable));
  }
  return kNo;
}

void add_inputs(CLI::App& command, AuditRobotArguments& arguments) {
  add_file_argument(command, "urdf", arguments.urdf, "The robot, with its meshes");
  add_file_argument(command, "spheres", arguments.spheres,
                    "Its spheres: spherized URDF, SRDF, cuRobo yml, XRDF, or JSON of foam, "
                    "MorphIt, ballpark or spherule; told apart by content");
  add_unknown_links_flag(command, arguments.ignores_unknown_links);
  add_geometry_option(command, "Which of the robot's geometries is to be covered",
                      arguments.geometry);
  add_package_option(command, arguments.packages);
  add_file(command, "--poses", arguments.poses.file,
           "Configurations (CSV) in which spheres of other links may cover too; the exit code is "
           "then about these");
  add_degrees_flag(command, "Angles of --poses are in degrees, lengths in metres", arguments.poses)
      ->needs("--poses");
  add_at_option(command, arguments.poses)->needs("--poses");
  add_file(command, "--srdf", arguments.pairs.srdf,
           "The robot's SRDF: tell the pairs of links apart, and judge those it disables");
  add_file(command, "--pairs", arguments.pairs.pairs,
           "What is proved of the pairs of links (NAME.pairs of robot, covered without padding): "
           "tell them apart by it; without it --srdf proves them first");
}

}  // namespace

void add_audit_robot(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "audit-robot",
      "Prove whether a file's spheres cover a robot, link by link; exit 0 covered, 1 leaks");
  auto arguments = std::make_shared<AuditRobotArguments>();
  arguments->command = command;
  add_inputs(*command, *arguments);
  command->add_option("--link", arguments->link,
                      "Whose spheres they are, if the file names no link");
  command
      ->add_option("--level", arguments->level,
                   "Which level of a file with levels, 0 the coarsest (default: the finest)")
      ->check(check_not_negative);
  add_threads_option(*command, arguments->threads);
  command->add_flag("--json", arguments->json, "Print the certificates as JSON");
  add_file(*command, "--view", arguments->view,
           "Write a page that shows the robot, the spheres (with --repair those) and their leaks "
           "(HTML, as view writes it)");
  add_file(*command, "--repair", arguments->repaired,
           "Where the file goes with spheres inflated and added so that they cover every link; "
           "exit 0 then says that these do");
  arguments->lengths.add_positive(*command, "--max-error", arguments->max_error,
                                  "E, metres: for which the spheres were made (default 0.01), and "
                                  "how far a repaired one may protrude (default: as far as half of "
                                  "the link's spheres do, and at least 1 % of its box diagonal)");
  arguments->lengths.add_positive(*command, "--min-external", arguments->min_external,
                                  "D, metres, for which the spheres were made (default: 4 E, or "
                                  "more for links that are very large for their E)");
  command->footer(to_text(
      {.text = "Lengths are in metres, as in the URDF, or have a unit of their own (5mm); the "
               "table is in millimetres.",
       .exit_codes = "0 every link is proved to be covered (with --poses: in these; with --repair: "
                     "by the repaired spheres); 1 leaks, or not proved",
       .examples = {
           "spherule audit-robot robot.urdf robot.curobo.yml",
           "spherule audit-robot robot.urdf robot.spheres.urdf --geometry visual --poses path.csv",
           "spherule audit-robot robot.urdf robot.curobo.yml --repair mended.yml --json"}}));
  command->callback([arguments, &exit_code] {
    arguments->lengths.convert(metres());
    exit_code = audit(*arguments);
  });
}

}  // namespace spherule
