// SPDX-License-Identifier: BSD-3-Clause
// Edges of a RobotChecker at many places of each: among sphere trees against all pairs of spheres
// in exact arithmetic, in scenes of all kinds of obstacles against the canonical tests of all
// pairs.
#include "tests/soak/robot_scenes.h"
#include "tests/soak/scale.h"
#include "tests/soak/tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace spherule::test {
namespace {

struct Edge {
  std::vector<double> from, to;
  double meeting = 0.5;  // where it is near contact, if it is
  bool is_near = false;
};

// Whether a motion may start or end there.
bool in_filter_range(const std::vector<double>& configuration) {
  return std::all_of(configuration.begin(), configuration.end(), [](double position) {
    return std::abs(position) <= RobotChecker::kLargestPosition;
  });
}

Edge make_edge(TreeScene& scene, SoakRandom& random) {
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

Edge make_edge(CheckerScene& scene, SoakRandom& random,
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

EdgeRequest random_request(SoakRandom& random) {
  EdgeRequest request{.first = random.chance(0.5)};
  if (random.chance(0.3)) request.resolution = random.magnitude(1e-6, 0.1);
  if (random.chance(0.1)) {
    request.max_configurations = static_cast<std::uint64_t>(random.whole(0, 60));
  }
  return request;
}

// What a result says has to be so wherever it is sampled.
template <class Scene>
class EdgeJudge {
 public:
  EdgeJudge(Tally& tally, Scene& scene, const Edge& edge, const EdgeResult& result)
      : tally_(tally), scene_(scene), edge_(edge), result_(result) {}

  void run(const std::string& place) {
    place_ = place;
    tally_.count(result_.verdict, edge_.is_near);
    const int steps = tally_.cases % 200 == 0 ? 5000 : 100;
    for (int i = 0; i <= steps; ++i) sample(static_cast<double>(i) / steps);
    sample_around(edge_.meeting);
    sample_around(std::max(0.0, std::nextafter(result_.free_until, 0.0)));
    if constexpr (std::is_same_v<Scene, CheckerScene>) {
      if (tally_.cases % 8 == 0) sample_around(nearest());
    }
    if (result_.verdict != Verdict::kCollision) return;
    go_to(result_.contact_at);
    if (!is_contact(scene_)) tally_.add_fault("no contact at contact_at, " + text());
  }

 private:
  // Within the slack.
  bool is_contact(TreeScene& scene) const { return scene.gap(at_).lower <= scene.slack(at_); }
  bool is_contact(CheckerScene& scene) const { return scene.touches(at_); }

  std::string text() const {
    return place_ + " from " + to_text(edge_.from) + " to " + to_text(edge_.to);
  }
  void go_to(double t) {
    at_.resize(edge_.from.size());
    for (std::size_t i = 0; i < at_.size(); ++i) {
      at_[i] = (1.0 - t) * edge_.from[i] + t * edge_.to[i];
    }
  }
  void sample(double t) {
    const bool is_called_free = result_.verdict == Verdict::kFree || t < result_.free_until;
    if (!is_called_free || is_missed_) return;
    go_to(t);
    if (!scene_.touches(at_)) return;
    is_missed_ = true;
    tally_.add_fault("contact is missed at t = " + to_text(std::span(&t, 1)) + ", " + text());
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
      go_to(t);
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

  Tally& tally_;
  Scene& scene_;
  const Edge& edge_;
  const EdgeResult& result_;
  std::string place_{};
  std::vector<double> at_{};
  bool is_missed_ = false;
};

TEST(ManyEdges, AmongTreesAreFreeWhereTheyAreCalledSo) {
  SoakRandom random(seeded(7));
  Tally tally{"edges among trees"};
  const int scenes = scaled(20);
  for (int n = 0; n < scenes; ++n) {
    TreeScene scene(random);
    const RobotChecker checker = scene.scene().snapshot();
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < 16; ++i) {
      const Edge edge = make_edge(scene, random);
      if (!in_filter_range(edge.from) || !in_filter_range(edge.to)) continue;
      const EdgeResult result =
          checker.check_edge(edge.from, edge.to, scratch, random_request(random));
      EdgeJudge(tally, scene, edge, result).run("scene " + std::to_string(n));
    }
  }
  tally.expect_telling();
}

TEST(ManyEdges, InScenesAreFreeWhereTheyAreCalledSo) {
  Tally any{"edges in scenes, any contact"}, first{"edges in scenes, first contact"};
  const auto edges = static_cast<std::uint64_t>(scaled(2'000));
  for (int n = 0; any.cases + first.cases < edges; ++n) {
    SoakRandom random(seeded(7'000'021) + static_cast<std::uint64_t>(n));
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
    for (int i = 0; i < 48; ++i) {
      if (i % 8 == 0) border = scene.find_border(random);
      const Edge edge = make_edge(scene, random, border);
      const EdgeRequest request = random_request(random);
      if (!scene.in_filter_range(edge.from) || !scene.in_filter_range(edge.to)) continue;
      const EdgeResult result = checker.check_edge(edge.from, edge.to, scratch, request);
      EdgeJudge(request.first ? first : any, scene, edge, result)
          .run("scene " + std::to_string(n) + ", edge " + std::to_string(i));
    }
  }
  any.expect_telling();
  first.expect_telling();
}

}  // namespace
}  // namespace spherule::test
