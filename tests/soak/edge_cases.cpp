// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/cases.h"
#include "tests/soak/soak_robot.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr int kEdgesOfAScene = 16;
constexpr int kSteps = 200;
constexpr int kManySteps = 10000;
constexpr std::uint64_t kManyStepsEvery = 1000;

struct Edge {
  std::vector<double> from, to;
  double meeting = 0.0;  // where it is near contact, if it is
  bool is_near = false;
};

// Whether a motion may start or end there.
bool in_filter_range(const std::vector<double>& configuration) {
  return std::all_of(configuration.begin(), configuration.end(), [](double position) {
    return std::abs(position) <= RobotChecker::kLargestPosition;
  });
}

Edge make_edge(SoakRobot& scene, SceneRandom& random) {
  Edge edge;
  std::vector<double> there = scene.anywhere(random);
  const std::vector<double> before = there;
  edge.is_near = random.chance(0.7) && scene.bring_to_gap(there, random.small_gap());
  if (!edge.is_near) there = before;
  edge.meeting = random.chance(0.1) ? random.whole(0, 1) : random.unit();
  const double length = random.magnitude(1e-3, 2.0);
  for (const double position : there) {
    const double change = random.chance(0.2) ? 0.0 : length * random.between(-1.0, 1.0);
    edge.from.push_back(position - edge.meeting * change);
    edge.to.push_back(edge.from.back() + change);
  }
  return edge;
}

class EdgeCheck {
 public:
  explicit EdgeCheck(SoakReport& report) : report_(report), tally_(report.add("robot, edge")) {}

  std::uint64_t edges() const { return tally_.cases; }

  void run(SceneRandom& random) {
    SoakRobot scene(random);
    const RobotChecker checker = scene.scene().snapshot();
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < kEdgesOfAScene; ++i) {
      const Edge edge = make_edge(scene, random);
      if (!in_filter_range(edge.from) || !in_filter_range(edge.to)) {
        continue;
      }
      EdgeRequest request{.first = random.chance(0.5)};
      if (random.chance(0.2)) request.resolution = random.magnitude(1e-6, 0.1);
      if (random.chance(0.1)) {
        request.max_configurations = static_cast<std::uint64_t>(random.whole(0, 20));
      }
      judge(scene, edge, checker.check_edge(edge.from, edge.to, scratch, request));
    }
  }

 private:
  static std::string text(const Edge& edge) {
    return " from " + to_text(edge.from) + " to " + to_text(edge.to);
  }

  void judge(SoakRobot& scene, const Edge& edge, const EdgeResult& result) {
    tally_.count(result.verdict, edge.is_near);
    const auto is_called_free = [&](double t) {
      return result.verdict == Verdict::kFree || t < result.free_until;
    };
    std::vector<double> at(edge.from.size());
    const auto go_to = [&](double t) {
      for (std::size_t i = 0; i < at.size(); ++i) {
        at[i] = (1.0 - t) * edge.from[i] + t * edge.to[i];
      }
    };
    bool touches = false, missed = false;
    const auto sample = [&](double t) {
      go_to(t);
      if (!scene.touches(at)) return;
      touches = true;
      if (is_called_free(t) && !missed) {
        missed = true;
        report_.add_fault(tally_, Fault::kMissed,
                          "contact at t = " + to_text(std::span(&t, 1)) + text(edge));
      }
    };
    const int steps = tally_.cases % kManyStepsEvery == 0 ? kManySteps : kSteps;
    for (int i = 0; i <= steps && !touches; ++i) sample(static_cast<double>(i) / steps);
    sample(edge.meeting);
    for (int i = 3; i < 40; i += 6) {
      sample(std::min(1.0, edge.meeting + std::ldexp(1.0, -i)));
      sample(std::max(0.0, edge.meeting - std::ldexp(1.0, -i)));
    }
    sample(std::max(0.0, std::nextafter(result.free_until, 0.0)));
    if (result.verdict == Verdict::kCollision) check_contact(scene, edge, at, result, go_to);
    if (result.verdict != Verdict::kFree && !touches) ++tally_.extra;
  }

  // The contact that was reported is one within the slack.
  template <class GoTo>
  void check_contact(SoakRobot& scene, const Edge& edge, const std::vector<double>& at,
                     const EdgeResult& result, GoTo go_to) {
    go_to(result.contact_at);
    const long double gap = scene.gap(at).lower;
    const double slack = scene.slack(at);
    tally_.worst_slack = std::max(tally_.worst_slack, static_cast<double>(gap / slack));
    if (gap > slack) report_.add_fault(tally_, Fault::kCrossed, "no contact" + text(edge));
  }

  SoakReport& report_;
  Tally& tally_;
};

}  // namespace

std::uint64_t check_edges(std::uint64_t motions, std::uint64_t seed, SoakReport& report) {
  SceneRandom random(seed);
  EdgeCheck check(report);
  while (check.edges() < motions) {
    check.run(random);
  }
  return check.edges();
}

}  // namespace spherule
