// SPDX-License-Identifier: BSD-3-Clause
// Edges of a RobotChecker against the canonical tests of all pairs at many places of each.
#include "tests/soak/cases.h"
#include "tests/soak/checker_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr int kEdgesOfAScene = 48;
constexpr int kSteps = 60;
constexpr int kManySteps = 3000;
constexpr std::uint64_t kManyStepsEvery = 200;

struct Edge {
  std::vector<double> from, to;
  double meeting = 0.5;  // where it is near contact, if it is
  bool is_near = false;
};

double least_gap(CheckerScene& scene, std::vector<double> at, std::size_t i, double change) {
  at[i] += change;
  return scene.gap(at);
}

// Takes out of a direction what goes towards the contact, so that an edge passes it.
void make_tangential(CheckerScene& scene, const std::vector<double>& at,
                     std::vector<double>& direction) {
  constexpr double kStep = 1e-6;
  double along = 0.0, square = 0.0;
  std::vector<double> slope;
  for (std::size_t i = 0; i < at.size(); ++i) {
    slope.push_back((least_gap(scene, at, i, kStep) - least_gap(scene, at, i, -kStep)) / kStep);
    if (!std::isfinite(slope.back())) return;
    along += slope.back() * direction[i];
    square += slope.back() * slope.back();
  }
  if (square == 0.0) return;
  for (std::size_t i = 0; i < at.size(); ++i) direction[i] -= along / square * slope[i];
}

Edge make_edge(CheckerScene& scene, SceneRandom& random,
               const std::optional<CheckerScene::Border>& border) {
  Edge edge;
  std::vector<double> there = scene.anywhere(random);
  edge.is_near = border && random.chance(0.8);
  std::vector<double> direction;
  for (std::size_t i = 0; i < there.size(); ++i) {
    direction.push_back(random.chance(0.2) ? 0.0 : random.between(-1.0, 1.0));
  }
  if (edge.is_near) {
    there = border->free;
    const double back = random.chance(0.2) ? 0.0 : random.magnitude(1e-12, 0.1);
    for (std::size_t i = 0; i < there.size(); ++i) {
      there[i] -=
          back * (border->contact[i] - border->free[i]) + 0.1 * back * random.between(-1.0, 1.0);
    }
    if (back > 1e-5 && random.chance(0.3)) make_tangential(scene, there, direction);
  }
  edge.meeting = random.chance(0.1) ? random.whole(0, 1) : random.unit();
  const double length = random.chance(0.02)  ? 0.0
                        : random.chance(0.1) ? 90.0
                                             : random.magnitude(1e-4, 3.0);
  for (std::size_t i = 0; i < there.size(); ++i) {
    edge.from.push_back(there[i] - edge.meeting * length * direction[i]);
    edge.to.push_back(edge.from.back() + length * direction[i]);
  }
  return edge;
}

class EdgeJudge {
 public:
  EdgeJudge(SoakReport& report, Tally& tally, CheckerScene& scene, const Edge& edge,
            const EdgeResult& result, const std::string& place)
      : report_(report),
        tally_(tally),
        scene_(scene),
        edge_(edge),
        result_(result),
        place_(place) {}

  void run() {
    tally_.count(result_.verdict, edge_.is_near);
    const int steps = tally_.cases % kManyStepsEvery == 0 ? kManySteps : kSteps;
    for (int i = 0; i <= steps; ++i) sample(static_cast<double>(i) / steps);
    sample_around(edge_.meeting);
    sample_around(std::max(0.0, std::nextafter(result_.free_until, 0.0)));
    if (tally_.cases % 8 == 0) sample_around(nearest());
    if (result_.verdict == Verdict::kCollision) {
      if (!touches(result_.contact_at)) {
        report_.add_fault(tally_, Fault::kOther, "no contact at contact_at, " + text());
      }
    }
    if (result_.verdict == Verdict::kUnknown && !has_contact_) ++tally_.extra;
  }

 private:
  std::string text() const {
    return place_ + " from " + to_text(edge_.from) + " to " + to_text(edge_.to);
  }
  bool touches(double t) {
    place(t);
    return scene_.touches(at_);
  }
  void place(double t) {
    at_.resize(edge_.from.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      at_[i] = (1.0 - t) * edge_.from[i] + t * edge_.to[i];
    }
  }
  bool is_called_free(double t) const {
    return result_.verdict == Verdict::kFree || t < result_.free_until;
  }
  void sample(double t) {
    if (has_contact_ && !is_called_free(t)) return;
    if (!touches(t)) return;
    has_contact_ = true;
    if (!is_called_free(t) || is_missed_) return;
    is_missed_ = true;
    report_.add_fault(tally_, Fault::kMissed,
                      "contact at t = " + to_text(std::span(&t, 1)) + ", " + text());
  }
  void sample_around(double t) {
    sample(t);
    for (int i = 3; i < 50; i += 4) {
      sample(std::min(1.0, t + std::ldexp(1.0, -i)));
      sample(std::max(0.0, t - std::ldexp(1.0, -i)));
    }
  }
  // Where the gap is least, as far as a search from the best of some places tells.
  double nearest() {
    const auto gap = [&](double t) {
      place(t);
      return scene_.gap(at_);
    };
    double best = 0.0, least = gap(0.0), width = 1.0 / 16;
    for (int i = 1; i <= 16; ++i) {
      const double here = gap(i / 16.0);
      if (here < least) best = i / 16.0, least = here;
    }
    for (int i = 0; i < 40; ++i, width *= 0.6) {
      for (const double t : {std::max(0.0, best - width), std::min(1.0, best + width)}) {
        const double here = gap(t);
        if (here < least) best = t, least = here;
      }
    }
    return best;
  }

  SoakReport& report_;
  Tally& tally_;
  CheckerScene& scene_;
  const Edge& edge_;
  const EdgeResult& result_;
  const std::string& place_;
  std::vector<double> at_{};
  bool has_contact_ = false;
  bool is_missed_ = false;
};

}  // namespace

std::uint64_t check_checker_edges(std::uint64_t edges, std::uint64_t seed, SoakReport& report) {
  Tally& any = report.add("checker, edge, any");
  Tally& first = report.add("checker, edge, first");
  for (std::uint64_t number = 0; any.cases + first.cases < edges; ++number) {
    SceneRandom random(seed * 1'000'003 + number);
    CheckerScene scene(random);
    if (scene.pair_count() == 0) continue;
    // Few of those that touch everywhere or nowhere.
    if (!scene.find_border(random) && !random.chance(0.1)) continue;
    InstructionSet instructions = best_instruction_set();
    if (random.chance(0.2)) instructions = InstructionSet::kPortable;
    if (random.chance(0.2) && is_available(InstructionSet::kAvx2)) {
      instructions = InstructionSet::kAvx2;
    }
    const RobotChecker checker = scene.scene().snapshot({.instructions = instructions});
    RobotChecker::Scratch scratch(checker);
    std::optional<CheckerScene::Border> border;
    for (int i = 0; i < kEdgesOfAScene; ++i) {
      if (i % 8 == 0) border = scene.find_border(random);
      const Edge edge = make_edge(scene, random, border);
      EdgeRequest request{.first = random.chance(0.5)};
      if (random.chance(0.3)) request.resolution = random.magnitude(1e-6, 0.1);
      if (random.chance(0.1)) {
        request.max_configurations = static_cast<std::uint64_t>(random.whole(0, 60));
      }
      if (!scene.in_filter_range(edge.from) || !scene.in_filter_range(edge.to)) continue;
      const EdgeResult result = checker.check_edge(edge.from, edge.to, scratch, request);
      const std::string place = "scene " + std::to_string(number) + ", edge " + std::to_string(i);
      EdgeJudge(report, request.first ? first : any, scene, edge, result, place).run();
    }
  }
  return any.cases + first.cases;
}

}  // namespace spherule
