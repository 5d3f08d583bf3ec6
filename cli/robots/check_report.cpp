// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/check_report.h"

#include "cli/robots/trajectory_input.h"
#include "cli/text/json.h"
#include "cli/text/message.h"
#include "cli/text/print.h"
#include "cli/text/units.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>

namespace spherule {
namespace {

const char* kind_of(const CheckedBody& body) {
  switch (body.kind) {
    case CheckedBody::Kind::kLink:
      return "link";
    case CheckedBody::Kind::kAttached:
      return "attached";
    case CheckedBody::Kind::kObstacle:
      break;
  }
  return "obstacle";
}

const TouchingPair* deepest(const CheckReport& report) {
  const auto found =
      std::max_element(report.found.pairs.begin(), report.found.pairs.end(),
                       [](const TouchingPair& a, const TouchingPair& b) {
                         return a.worst.contact.overlap_depth < b.worst.contact.overlap_depth;
                       });
  return found == report.found.pairs.end() ? nullptr : &*found;
}

const char* name_of(ContinuousMotion continuous) {
  return continuous == ContinuousMotion::kAsGiven ? "as-given" : "shortest";
}

// Which motions of continuous joints were proved.
void put_continuous(std::ostream& out, const CheckReport& report) {
  if (!report.turns.continuous) return;
  const TurningMotions& turning = report.turns.turning;
  out << "continuous joints turn "
      << (report.turns.continuous == ContinuousMotion::kAsGiven
              ? "as given, straight from number to number"
              : "the shorter way, by at most half a turn");
  if (turning.count > 0) {
    out << "; " << describe(turning, report.is_in_degrees);
    if (report.turns.continuous == ContinuousMotion::kShortest) {
      out << " as given, here by " << angle_text(turning.shorter, report.is_in_degrees);
    }
  }
  out << "\n";
}

Json to_json(const OutsideLimits& outside, bool enforced) {
  Json json{{"outside", outside.count}, {"enforced", enforced}, {"first", nullptr}};
  if (outside.count == 0) return json;
  json["first"] = {{"line", outside.line},
                   {"joint", outside.joint},
                   {"position", spherule::to_json(outside.position)},
                   {"lower", spherule::to_json(outside.lower)},
                   {"upper", spherule::to_json(outside.upper)}};
  return json;
}

Json to_json(const TurningMotions& turning) {
  Json json{{"count", turning.count}, {"first", nullptr}};
  if (turning.count == 0) return json;
  json["first"] = {{"line", turning.line},
                   {"to_line", turning.to_line},
                   {"joint", turning.joint},
                   {"step", spherule::to_json(turning.step)},
                   {"shorter", spherule::to_json(turning.shorter)}};
  return json;
}

Json to_json(const CheckedBody& body) {
  Json json{{"kind", kind_of(body)}, {"name", body.name}};
  if (body.sphere >= 0) {
    json["tree"] = body.tree;
    json["sphere"] = body.sphere;
  }
  return json;
}

Json to_json(const TrajectoryPoint& point, const char* fraction) {
  Json json{{"line", point.line}};
  if (point.to_line > 0) {
    json["to_line"] = point.to_line;
    json[fraction] = spherule::to_json(point.fraction);
  }
  return json;
}

Json to_json(const FoundContact& found) {
  Json json = to_json(found.at, "fraction");
  json["first"] = to_json(found.contact.first);
  json["second"] = to_json(found.contact.second);
  json["depth"] = spherule::to_json(found.contact.overlap_depth);
  json["padding"] = spherule::to_json(found.contact.padding);
  json["point"] = spherule::to_json(found.contact.world_point);
  return json;
}

std::string text_of(const TrajectoryPoint& point) {
  std::ostringstream text;
  text << point.line;
  if (point.to_line > 0) {
    text << "-" << point.to_line << " at " << std::fixed << std::setprecision(4) << point.fraction;
  }
  return text.str();
}

std::string text_of(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(4) << point.x() << " " << point.y() << " " << point.z();
  return text.str();
}

// -1 for what is no link.
int link_of(const RobotModel& robot, const CheckedBody& body) {
  return body.kind == CheckedBody::Kind::kLink ? robot.find_link(body.name) : -1;
}

// Free boxes of the two do not matter where they touch.
std::string kind_of_contact(const PairStatus& status) {
  switch (*status.verdict) {
    case PairVerdict::kNever:
      return "never within the limits";
    case PairVerdict::kTouching:
      return "can touch";
    case PairVerdict::kUnknown:
      break;
  }
  return "unknown";
}

std::string overlap_in_mm(double metres) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << metres * kMillimetresPerMetre;
  return text.str();
}

// Pairs whose spheres overlap though they are free, a line each.
void put_proved_free(std::ostream& out, const CheckReport& report) {
  for (const TouchingPair& pair : report.found.proved_free) {
    const CheckedContact& worst = pair.worst.contact;
    out << "free though spheres overlap: " << one_line(worst.first.name) << " and "
        << one_line(worst.second.name) << (pair.kind.empty() ? "" : " (" + pair.kind + ")")
        << ", in " << pair.count << " of " << report.found.explained << " configurations, up to "
        << overlap_in_mm(worst.overlap_depth) << " mm\n";
  }
}

Json to_json(const TouchingPair& pair) {
  Json json{{"first", pair.first.contact.first.name},
            {"second", pair.first.contact.second.name},
            {"count", pair.count},
            {"first_contact", to_json(pair.first)},
            {"worst_contact", to_json(pair.worst)}};
  if (!pair.kind.empty()) json["kind"] = pair.kind;
  return json;
}

}  // namespace

const char* verdict_of(const CheckReport& report) {
  if (report.found.colliding > 0) return "collision";
  if (report.is_out_of_bounds()) return "outside limits";
  return report.is_free() ? "free" : "not proved";
}

std::optional<std::size_t> PairIndex::find_or_add(const CheckedContact& contact, std::size_t next) {
  const auto [place, is_new] = places_.try_emplace({contact.first.name, contact.second.name}, next);
  return is_new ? std::nullopt : std::optional(place->second);
}

void PairCounter::add(const FoundContact& first, const FoundContact& deepest) {
  const std::optional<std::size_t> known = places_.find_or_add(first.contact, pairs_.size());
  const std::size_t at_start = first.at.fraction == 0.0 ? 1 : 0;
  if (!known) {
    pairs_.push_back({1, at_start, first, deepest});
    return;
  }
  TouchingPair& pair = pairs_[*known];
  ++pair.count;
  pair.at_start += at_start;
  if (deepest.contact.overlap_depth > pair.worst.contact.overlap_depth) pair.worst = deepest;
}

void TrajectoryFindings::tell_kinds(const RobotModel& robot,
                                    const std::vector<PairStatus>& statuses) {
  std::map<std::pair<int, int>, const PairStatus*> status_of;
  for (const PairStatus& status : statuses) {
    status_of.try_emplace({status.first, status.second}, &status);
  }
  for (std::vector<TouchingPair>* const list : {&pairs, &proved_free}) {
    for (TouchingPair& pair : *list) {
      const std::pair<int, int> links = std::minmax(link_of(robot, pair.first.contact.first),
                                                    link_of(robot, pair.first.contact.second));
      const auto status = status_of.find(links);
      if (status == status_of.end() || !status->second->verdict) continue;
      pair.kind = list == &proved_free ? std::string(kind_of(*status->second))
                                       : kind_of_contact(*status->second);
    }
  }
}

std::vector<TouchingPair> always_touching(const CheckReport& report) {
  const std::size_t all = report.found.motions.value_or(report.configurations);
  std::vector<TouchingPair> result;
  std::copy_if(report.found.pairs.begin(), report.found.pairs.end(), std::back_inserter(result),
               [&](const TouchingPair& pair) {
                 return all > 1 && pair.at_start == all &&
                        pair.first.contact.second.kind != CheckedBody::Kind::kObstacle;
               });
  return result;
}

std::string check_table(const CheckReport& report) {
  std::ostringstream text;
  if (report.shard.of > 1)
    text << "shard " << report.shard.index << " of " << report.shard.of << ", ";
  text << verdict_of(report) << ": " << report.configurations << " configurations";
  if (report.found.motions) {
    text << ", " << *report.found.motions << " motions, " << report.found.colliding
         << " of them collide, " << report.found.not_proved.size() << " are not proved free\n";
  } else {
    text << ", " << report.found.colliding << " of them collide\n";
  }
  if (!report.given_spheres.empty()) {
    text << "this is about the spheres of " << one_line(report.given_spheres)
         << " as given; whether they cover the robot is for spherule audit-robot to prove\n";
  }
  put_continuous(text, report);
  if (report.is_out_of_bounds()) {
    text << describe(report.outside, report.configurations, report.is_in_degrees) << "\n";
  }
  if (!report.found.pairs.empty()) {
    const bool has_kinds = std::any_of(report.found.pairs.begin(), report.found.pairs.end(),
                                       [](const TouchingPair& pair) { return !pair.kind.empty(); });
    std::vector<std::vector<std::string>> rows = {{"body", "touches", "times", "first at line",
                                                   "deepest at line", "depth there/mm", "where/m",
                                                   has_kinds ? "kind" : ""}};
    for (const TouchingPair& pair : report.found.pairs) {
      const CheckedContact& worst = pair.worst.contact;
      rows.push_back({worst.first.name, worst.second.name, std::to_string(pair.count),
                      text_of(pair.first.at), text_of(pair.worst.at),
                      overlap_in_mm(worst.overlap_depth), text_of(worst.world_point), pair.kind});
    }
    text << aligned(rows);
  }
  put_proved_free(text, report);
  constexpr std::size_t kMost = 20;
  for (std::size_t i = 0; i < std::min(kMost, report.found.not_proved.size()); ++i) {
    text << "not proved beyond line " << text_of(report.found.not_proved[i]) << "\n";
  }
  if (report.found.not_proved.size() > kMost) {
    text << "and " << report.found.not_proved.size() - kMost << " more\n";
  }
  return text.str();
}

std::string check_json(const CheckReport& report) {
  Json json{{"verdict", verdict_of(report)}, {"configurations", report.configurations}};
  if (report.found.motions) json["motions"] = *report.found.motions;
  json["spheres"] = report.given_spheres.empty() ? "proved" : "given";
  if (report.shard.of > 1) {
    json["shard"] = {{"index", report.shard.index}, {"of", report.shard.of}};
  }
  if (report.turns.continuous) {
    json["continuous"] = name_of(*report.turns.continuous);
    json["more_than_half_a_turn"] = to_json(report.turns.turning);
  }
  json["limits"] = to_json(report.outside, report.enforces_limits);
  json["colliding"] = report.found.colliding;
  const TouchingPair* worst = deepest(report);
  json["first_contact"] = worst ? to_json(report.found.pairs.front().first) : Json(nullptr);
  json["worst_contact"] = worst ? to_json(worst->worst) : Json(nullptr);
  json["pairs"] = Json::array();
  for (const TouchingPair& pair : report.found.pairs) json["pairs"].push_back(to_json(pair));
  json["proved_free"] = Json::array();
  for (const TouchingPair& pair : report.found.proved_free) {
    json["proved_free"].push_back(to_json(pair));
  }
  json["not_proved"] = Json::array();
  for (const TrajectoryPoint& point : report.found.not_proved) {
    json["not_proved"].push_back(to_json(point, "free_until"));
  }
  return to_text(json);
}

}  // namespace spherule
