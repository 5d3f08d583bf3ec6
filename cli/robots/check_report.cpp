// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/check_report.h"

#include "base/threads.h"
#include "cli/robots/trajectory.h"
#include "cli/text/json.h"
#include "cli/text/print.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

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

Json to_json(const TouchingPair& pair) {
  Json json{{"first", pair.first.contact.first.name},
            {"second", pair.first.contact.second.name},
            {"count", pair.count},
            {"first_contact", to_json(pair.first)},
            {"worst_contact", to_json(pair.worst)}};
  if (!pair.kind.empty()) json["kind"] = pair.kind;
  return json;
}

class TrajectoryCheck {
 public:
  TrajectoryCheck(const RobotChecker& checker, const Trajectory& trajectory,
                  const TrajectoryCheckOptions& options)
      : checker_(checker),
        trajectory_(trajectory),
        options_(options),
        scratches_(make_scratches(checker, options.threads)),
        places_(places_of(options.configurations_in_all > 0 ? options.configurations_in_all
                                                            : trajectory.size())) {}

  TrajectoryFindings configurations() && {
    std::vector<std::uint8_t> free(trajectory_.size());
    const std::span all(trajectory_.positions);
    in_blocks(free.size(), [&](std::size_t first, std::size_t count) {
      checker_.check_configs(all.subspan(first * trajectory_.width, count * trajectory_.width),
                             scratches_, std::span(free).subspan(first, count));
    });
    count_proved_free();
    for (std::size_t i = 0; i < free.size(); ++i) {
      if (free[i] != 0) continue;
      ++found_.colliding;
      explain(trajectory_.configuration(i), {.line = trajectory_.lines[i]});
    }
    found_.verdicts.free = std::move(free);
    return take();
  }

  TrajectoryFindings motions() && {
    const std::size_t count = std::max<std::size_t>(trajectory_.size(), 1) - 1;
    const std::span all(trajectory_.positions);
    const std::size_t width = trajectory_.width;
    EdgeRequest request = options_.edge;
    request.first = true;
    std::vector<EdgeResult> results;
    in_blocks(count, [&](std::size_t first, std::size_t edges) {
      const std::vector<EdgeResult> some = checker_.check_edges(
          all.subspan(first * width, edges * width),
          all.subspan((first + 1) * width, edges * width), scratches_, request);
      results.insert(results.end(), some.begin(), some.end());
    });
    found_.motions = count;
    count_proved_free();
    found_.colliding = static_cast<std::size_t>(
        std::ranges::count(results, Verdict::kCollision, &EdgeResult::verdict));
    for (std::size_t i = 0; i < count; ++i) {
      if (options_.progress && i % kLeastBlock == 0) {
        options_.progress(static_cast<double>(i) / static_cast<double>(count), "finding contacts");
      }
      if (results[i].verdict == Verdict::kCollision) {
        explain_motion(i, results[i].contact_at);
      } else if (results[i].verdict == Verdict::kUnknown) {
        found_.not_proved.push_back({.line = trajectory_.lines[i],
                                     .to_line = trajectory_.lines[i + 1],
                                     .fraction = results[i].free_until});
      }
    }
    found_.verdicts.motions = std::move(results);
    return take();
  }

 private:
  // So many at a time that the bar moves and the threads have enough to do.
  template <typename Check>
  void in_blocks(std::size_t count, Check check) const {
    const std::size_t block = std::max<std::size_t>(count / 50, kLeastBlock);
    for (std::size_t first = 0; first < count; first += block) {
      if (options_.progress) {
        options_.progress(static_cast<double>(first) / static_cast<double>(count), "checking");
      }
      check(first, std::min(block, count - first));
    }
  }

  void count_proved_free() {
    found_.explained = options_.explained;
    for (std::size_t i = 0; i < found_.explained; ++i) {
      for (const CheckedContact& contact : checker_.explain(
               trajectory_.configuration(i), scratches_.front(), {.proved_free = true})) {
        if (contact.is_proved_free) {
          const FoundContact found{{.line = trajectory_.lines[i]}, contact};
          proved_free_.add(found, found);
        }
      }
    }
  }

  TrajectoryFindings take() {
    found_.pairs = pairs_.take();
    found_.proved_free = proved_free_.take();
    return std::move(found_);
  }

  void explain(std::span<const double> configuration, const TrajectoryPoint& at) {
    for (const CheckedContact& contact : checker_.explain(configuration, scratches_.front())) {
      pairs_.add({at, contact}, {at, contact});
    }
  }

  // Where a motion first touches, and at places on the rest of it: of every two bodies that touch
  // there the first and the deepest contact.
  void explain_motion(std::size_t motion, double contact_at) {
    PairCounter found;
    for (std::size_t k = 0; k <= places_; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(places_);
      const TrajectoryPoint at{.line = trajectory_.lines[motion],
                               .to_line = trajectory_.lines[motion + 1],
                               .fraction = contact_at + share * (1.0 - contact_at)};
      const std::vector<double> configuration = checker_.configuration_on_edge(
          trajectory_.configuration(motion), trajectory_.configuration(motion + 1), at.fraction,
          options_.edge.continuous);
      for (const CheckedContact& contact : checker_.explain(configuration, scratches_.front())) {
        found.add({at, contact}, {at, contact});
      }
    }
    for (const TouchingPair& pair : found.take()) pairs_.add(pair.first, pair.worst);
  }

  // How many places of a motion are searched: 24, of trajectories of more than 1,666 configurations
  // fewer, so that this takes a fraction of a second, but at least 4.
  static std::size_t places_of(std::size_t configurations) {
    constexpr std::size_t kInAll = 40000;
    return std::clamp<std::size_t>(kInAll / std::max<std::size_t>(configurations, 1), 4, 24);
  }

  static constexpr std::size_t kLeastBlock = 256;

  const RobotChecker& checker_;
  const Trajectory& trajectory_;
  const TrajectoryCheckOptions& options_;
  std::vector<RobotChecker::Scratch> scratches_;
  const std::size_t places_;
  TrajectoryFindings found_;
  PairCounter pairs_;
  PairCounter proved_free_;
};

}  // namespace

const char* verdict_of(const CheckReport& report) {
  if (report.found.colliding > 0) return "collision";
  if (report.is_out_of_bounds()) return "outside limits";
  return report.is_free() ? "free" : "not proved";
}

void PairCounter::add(const FoundContact& first, const FoundContact& deepest) {
  const auto [place, is_new] =
      places_.try_emplace({first.contact.first.name, first.contact.second.name}, pairs_.size());
  if (is_new) pairs_.push_back({.first = first, .worst = deepest});
  TouchingPair& pair = pairs_[place->second];
  ++pair.count;
  pair.at_start += first.at.fraction == 0.0 ? 1 : 0;
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

Json check_json(const CheckReport& report) {
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
  return json;
}

std::string check_table(const CheckReport& report, const Json& json) {
  std::string text = lines(json, {{"shard", "shard {shard.index} of {shard.of}, "},
                                  {"", "{verdict}: {configurations} configurations"},
                                  {"motions", ", {} motions"},
                                  {"", ", {colliding} of them collide"}});
  if (report.found.motions) {
    text += concat(", ", report.found.not_proved.size(), " are not proved free");
  }
  text += "\n";
  if (!report.given_spheres.empty()) {
    text += "this is about the spheres of " + one_line(report.given_spheres) +
            " as given; whether they cover the robot is for spherule audit-robot to prove\n";
  }
  text += describe(report.turns, report.is_in_degrees);
  if (report.is_out_of_bounds()) {
    text += describe(report.outside, report.configurations, report.is_in_degrees) + "\n";
  }
  Json pairs = json["pairs"];
  for (Json& pair : pairs) {
    for (const char* contact : {"first_contact", "worst_contact"}) {
      pair[contact]["at"] =
          lines(pair[contact], {{"", "{line}"}, {"to_line", "-{} at {fraction:f4}"}});
    }
    pair.emplace("kind", "");
  }
  if (!pairs.empty()) {
    const bool has_kinds = std::ranges::any_of(
        report.found.pairs, [](const TouchingPair& pair) { return !pair.kind.empty(); });
    text +=
        table(pairs,
              {{"body", "{first}"},
               {"touches", "{second}"},
               {"times", "{count}"},
               {"first at line", "{first_contact.at}"},
               {"deepest at line", "{worst_contact.at}"},
               {"depth there/mm", "{worst_contact.depth:mmf2}"},
               {"where/m",
                "{worst_contact.point.0:f4} {worst_contact.point.1:f4} {worst_contact.point.2:f4}"},
               {has_kinds ? "kind" : "", "{kind}"}});
  }
  for (const Json& pair : json["proved_free"]) {
    text += lines(pair, {{"", "free though spheres overlap: {first} and {second}"},
                         {"kind", " ({})"},
                         {"", ", in {count}"}}) +
            concat(" of ", report.found.explained) +
            filled(" configurations, up to {worst_contact.depth:mmf2} mm\n", pair);
  }
  constexpr std::size_t kMost = 20;
  const std::size_t count = json["not_proved"].size();
  for (std::size_t i = 0; i < std::min(kMost, count); ++i) {
    text += filled("not proved beyond line {line}-{to_line} at {free_until:f4}\n",
                   json["not_proved"][i]);
  }
  if (count > kMost) text += concat("and ", count - kMost, " more\n");
  return text;
}

std::vector<RobotChecker::Scratch> make_scratches(const RobotChecker& checker, int threads) {
  std::vector<RobotChecker::Scratch> scratches;
  for (std::size_t i = 0; i < internal::thread_count(threads); ++i) scratches.emplace_back(checker);
  return scratches;
}

TrajectoryFindings check_configurations(const RobotChecker& checker, const Trajectory& trajectory,
                                        const TrajectoryCheckOptions& options) {
  return TrajectoryCheck(checker, trajectory, options).configurations();
}

TrajectoryFindings check_motions(const RobotChecker& checker, const Trajectory& trajectory,
                                 const TrajectoryCheckOptions& options) {
  return TrajectoryCheck(checker, trajectory, options).motions();
}

}  // namespace spherule
