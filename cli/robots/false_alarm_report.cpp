// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/false_alarm_report.h"

#include "cli/robots/pair_report.h"
#include "cli/text/message.h"
#include "cli/text/print.h"
#include "cli/text/units.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>
#include <string_view>

namespace spherule {
namespace {

constexpr std::size_t kShownPairs = 5;
// Meshes nearer to each other than this part of the E of their links together touch, for spheres.
constexpr double kReallyClose = 1.0 / 16.0;

std::string millimetres(double length) {
  std::ostringstream out;
  const double value = length * kMillimetresPerMetre;
  out << std::fixed << std::setprecision(value < 10.0 ? 1 : 0) << value << " mm";
  return out.str();
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
