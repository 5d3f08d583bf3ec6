// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_report.h"

#include "cli/files/warnings.h"
#include "cli/options/robot_options.h"
#include "cli/robots/pair_report.h"
#include "cli/text/print.h"
#include "simplifier/option_record.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Over all links.
struct Totals {
  explicit Totals(std::span<const LinkCover> all) {
    for (const LinkCover& link : all) {
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
  }

  std::size_t links = 0;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  bool covered = true;
  double depth = 0.0;
  double protrusion = 0.0;
  double over_mesh = 0.0;
};

const std::string& name_of(LinkGeometry geometry) {
  static const std::vector<std::string> names = geometry_names();
  return names[geometry == LinkGeometry::kCollision ? 0 : 1];
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

// In millimetres.
std::string mm(double metres, int digits) {
  return decimal(metres * kMillimetresPerMetre, digits);
}

// A depth that is proved to be none is shown as a bare 0; no other is.
std::string depth_text(bool covered, double depth) {
  if (covered) return "0";
  std::ostringstream out;
  out << std::setprecision(3) << depth * kMillimetresPerMetre;
  return out.str();
}

std::vector<std::string> row_of(const std::string& name, double max_error, const Totals& sums) {
  return {name,
          mm(max_error, 1),
          std::to_string(sums.triangles),
          std::to_string(sums.spheres),
          depth_text(sums.covered, sums.depth),
          mm(sums.protrusion, 2),
          mm(sums.over_mesh, 2)};
}

constexpr double kLitresPerCubicMetre = 1e3;
constexpr double kLargestRatio = 1e4;

// D of the links, and how much wider a way may be and still be filled.
std::string describe_filling(const RobotCover& cover) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double least = kNone;
  double most = 0.0;
  double slack = 0.0;
  for (const LinkCover& link : cover.links) {
    if (!link.fit) continue;
    const ExternalSpheres& external = link.fit->external;
    least = std::min(least, external.min_external_diameter);
    most = std::max(most, external.min_external_diameter);
    slack = std::max(slack, external.closing_slack / external.min_external_diameter);
  }
  if (least == kNone) return {};
  return "filled: what is narrower than D = " + mm(least, 1) +
         (most > least ? " to " + mm(most, 1) : "") +
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

void describe_pairs(const FalseAlarms& alarms, const RobotModel& robot, const RobotCover& cover,
                    std::ostream& out) {
  const auto of_free = [&](std::size_t count) {
    return percent(RefusedShare{alarms.free, count}.share());
  };
  for (std::size_t i = 0; i < std::min(kShownPairs, alarms.pairs.size()); ++i) {
    const PairAlarms& pair = alarms.pairs[i];
    out << "  " << one_line(link_name(robot, pair.first)) << " and "
        << one_line(link_name(robot, pair.second)) << ": " << of_free(pair.refused) << ", "
        << of_free(pair.refused_alone) << " alone, meshes " << millimetres(pair.median_gap)
        << " apart; " << remedy(pair, cover) << "\n";
  }
  if (alarms.pairs.size() > kShownPairs) {
    out << "  and " << alarms.pairs.size() - kShownPairs << " more pairs\n";
  }
}

std::string_view words_for(PairProofs proofs) {
  switch (proofs) {
    case PairProofs::kNever:
      return "where pairs that never touch are tested";
    case PairProofs::kBoxes:
      return "where only pairs that never touch are ignored, as cuRobo and MoveIt do";
    case PairProofs::kNone:
      break;
  }
  return "where no pair is ignored";
}

void describe_choice(const MeasuredCover& measured, std::ostream& out) {
  const LinkErrorChoice& choice = *measured.choice;
  out << "  goal " << percent(*measured.goal) << ": "
      << (choice.is_reached ? "reached" : "not reached") << " with " << choice.spheres
      << " spheres; E of " << millimetres(measured.cover.options.max_error)
      << " everywhere would take " << choice.coarsest_spheres << " and refuse "
      << percent(choice.coarsest.refused_share().share()) << "\n";
  if (!choice.is_reached && measured.random.refused_share().share() <= *measured.goal) {
    out << "  so few postures do not show it: try more (--postures)\n";
  }
}

}  // namespace

Json robot_summary(const std::string& urdf, const RobotCover& cover, double seconds) {
  const Totals totals(cover.links);
  Json json = Json::object();
  json["format"] = "spherule-robot-report";
  json["version"] = 1;
  json["urdf"] = urdf;
  json["robot"] = cover.robot;
  json["geometry"] = name_of(cover.options.geometry);
  json["total"] = {{"links", totals.links},
                   {"triangles", totals.triangles},
                   {"sphere_count", totals.spheres},
                   {"covered", totals.covered},
                   {"uncovered_depth_max", to_json(totals.depth)},
                   {"protrusion_over_simplified_max", to_json(totals.protrusion)},
                   {"protrusion_over_mesh_max", to_json(totals.over_mesh)},
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

std::string robot_table(const RobotCover& cover, double seconds) {
  std::vector<std::vector<std::string>> rows = {{"link", "E/mm", "triangles", "spheres",
                                                 "uncovered/mm", "protrusion/mm", "over mesh/mm",
                                                 "volume", "filled/l", "seconds", ""}};
  for (const LinkCover& link : cover.links) {
    if (!link.fit) {
      rows.push_back({link.link, "no " + name_of(cover.options.geometry) + " geometry"});
      rows.back().resize(rows.front().size());
      continue;
    }
    const std::optional<double>& volume = link.fit->certificate.volume_ratio;
    const std::optional<double>& filled = link.fit->certificate.filled_volume;
    std::vector<std::string> row =
        row_of(link.link, link.fit->options.max_error, Totals({&link, 1}));
    row.push_back(!volume                   ? "-"      // an open mesh has none
                  : *volume > kLargestRatio ? "> 1e4"  // next to none in the mesh
                                            : decimal(*volume, 2));
    row.push_back(filled ? decimal(*filled * kLitresPerCubicMetre, 3) : "-");
    row.push_back(decimal(link.seconds, 1));
    row.emplace_back(link.fit->interrupted ? "*" : "");
    rows.push_back(std::move(row));
  }
  std::vector<std::string> total = row_of("total", cover.options.max_error, Totals(cover.links));
  total.insert(total.end(), {"", "", decimal(seconds, 1), ""});
  rows.push_back(std::move(total));
  return aligned(rows) +
         (links_interrupted(cover).empty() ? "" : "* " + std::string(kInterruptedSearch) + "\n") +
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

std::string describe_false_alarms(const MeasuredCover& measured, const RobotModel& robot) {
  if (measured.random.postures == 0) return {};
  const FalseAlarms& alarms = measured.random;
  std::ostringstream out;
  out << "false alarms: " << percent(alarms.refused_share().share()) << " of " << alarms.free
      << " free postures (of " << alarms.postures
      << " random ones) are refused because of spheres, "
      << "at most " << percent(measured.upper_bound) << " of all with "
      << std::lround(100.0 * LinkErrorChoice::kConfidence) << " % confidence";
  if (alarms.proofs != PairProofs::kNone) {
    out << "; " << percent(alarms.refused_share(PairProofs::kNone).share()) << " "
        << words_for(PairProofs::kNone);
  }
  if (alarms.proofs == PairProofs::kBoxes) {
    out << ", " << percent(alarms.refused_share(PairProofs::kNever).share()) << " "
        << words_for(PairProofs::kBoxes);
  }
  out << "\n";
  for (const auto& [first, second] : alarms.always_touching) {
    out << "  not counted: the meshes of " << one_line(link_name(robot, first)) << " and "
        << one_line(link_name(robot, second))
        << " touch in all postures; disable the pair (--srdf)\n";
  }
  if (measured.choice) describe_choice(measured, out);
  describe_pairs(alarms, robot, measured.cover, out);
  if (measured.given.postures > 0) {
    out << "  given postures: " << percent(measured.given.refused_share().share()) << " of "
        << measured.given.free << " free ones (of " << measured.given.postures << ")\n";
    describe_pairs(measured.given, robot, measured.cover, out);
  }
  return out.str();
}

}  // namespace spherule
