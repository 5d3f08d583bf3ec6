// SPDX-License-Identifier: BSD-3-Clause
// Configurations and edges of a RobotChecker in scenes of all kinds of obstacles, against the
// canonical tests of all pairs, one by one; those of sphere trees also in exact arithmetic.
#include "tests/soak/robot_scenes.h"
#include "tests/soak/scale.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// Exact to the bit.
std::string to_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), " %.17g", number);
    text += buffer.data();
  }
  return text;
}

// Counts the answers to one question; each fault fails the test, and the first ones say how to see
// them again.
struct Tally {
  std::string question;
  std::uint64_t cases = 0;
  std::uint64_t near = 0;  // made to be within 2 mm of contact
  std::uint64_t hits = 0;  // answers: collision, free, unknown
  std::uint64_t free = 0;
  std::uint64_t unknown = 0;
  std::uint64_t faults = 0;

  void count(Verdict verdict, bool is_near) {
    ++cases;
    near += is_near ? 1 : 0;
    ++(verdict == Verdict::kCollision ? hits : verdict == Verdict::kFree ? free : unknown);
  }

  void add_fault(const std::string& what) {
    constexpr std::uint64_t kShown = 20;
    if (++faults <= kShown) ADD_FAILURE() << question << ", case " << cases << ": " << what;
  }

  // Whether there were both answers, and cases near contact, to be judged.
  void expect_telling() const {
    EXPECT_EQ(faults, 0U) << question;
    EXPECT_GT(hits, 0U) << question;
    EXPECT_GT(free, cases / 20) << question;
    EXPECT_GT(near, cases / 5) << question;
  }
};

// A scene of a number; nothing if nothing is tested in it, and for most of those that touch
// everywhere or nowhere.
std::unique_ptr<CheckerScene> make_scene(Random& random) {
  auto scene = std::make_unique<CheckerScene>(random);
  if (scene->pair_count() == 0) return nullptr;
  return scene->find_border(random) || random.chance(0.1) ? std::move(scene) : nullptr;
}

constexpr std::size_t kConfigurations = 251;  // of a scene: no whole number of lanes

// Configurations, one behind the other, and what is known of each.
struct QueriedConfigurations {
  std::vector<double> positions;
  std::vector<std::uint8_t> is_near, truth;

  std::span<const double> operator[](std::size_t i) const {
    const std::size_t variables = positions.size() / truth.size();
    return std::span(positions).subspan(i * variables, variables);
  }
};

// Anywhere, on paths, and around where contact begins, at gaps of all orders of magnitude.
QueriedConfigurations make_configurations(CheckerScene& scene, Random& random) {
  QueriedConfigurations made;
  std::vector<double> last = scene.anywhere(random);
  std::optional<CheckerScene::Border> border;
  while (made.truth.size() < kConfigurations) {
    if (made.truth.size() % 32 == 0) border = scene.find_border(random);
    std::vector<double> next;
    const double kind = random.unit();
    const bool is_near = border && kind < 0.7;
    if (is_near) {
      next = random.chance(0.5) ? border->free : border->contact;
      const double far = random.chance(0.2) ? 0.0 : random.magnitude(1e-17, 1e-2);
      const bool is_one = random.chance(0.5);
      const auto one = static_cast<std::size_t>(random.whole(0, static_cast<int>(next.size()) - 1));
      for (std::size_t i = 0; i < next.size(); ++i) {
        if (is_one && i != one) continue;
        next[i] += far * random.between(-1.0, 1.0);
      }
    } else if (kind < 0.9) {
      next = last;
      for (double& position : next) position += random.between(-0.01, 0.01);
    } else {
      next = scene.anywhere(random);
    }
    last = next;
    made.positions.insert(made.positions.end(), next.begin(), next.end());
    made.is_near.push_back(is_near ? 1 : 0);
    made.truth.push_back(scene.touches(next) ? 1 : 0);
  }
  return made;
}

// Calls judge(i, is_free) for each configuration, each instruction set and both ways of asking.
template <class Judge>
void query(const RobotScene& scene, const QueriedConfigurations& queried, const Judge& judge) {
  std::vector<std::uint8_t> free(queried.truth.size());
  for (const InstructionSet set : instruction_sets()) {
    const RobotChecker checker = scene.snapshot({.instructions = set});
    RobotChecker::Scratch scratch(checker);
    for (std::size_t i = 0; i < free.size(); ++i) {
      judge(i, checker.check_config(queried[i], scratch));
    }
    checker.check_configs(queried.positions, scratch, free);
    for (std::size_t i = 0; i < free.size(); ++i) judge(i, free[i] != 0);
  }
}

TEST(ManyConfigurations, AreAnsweredAsByTheCanonicalTests) {
  Tally tally{"configurations"};
  for (int n = 0, made = 0; made < scaled(90); ++n) {
    Random random(seeded(7'000'021) + static_cast<std::uint64_t>(n));
    const auto scene = make_scene(random);
    if (!scene) continue;
    const QueriedConfigurations queried = make_configurations(*scene, random);
    const auto add_fault = [&](const std::string& what, std::size_t i) {
      tally.add_fault(what + ", scene " + std::to_string(n) + ", configuration" +
                      to_text(queried[i]));
    };
    for (std::size_t i = 0; i < kConfigurations; ++i) {
      const std::string fault = scene->fault_of_trees(queried[i]);
      if (!fault.empty()) add_fault("trees: " + fault, i);
    }
    query(scene->scene(), queried, [&](std::size_t i, bool is_free) {
      tally.count(is_free ? Verdict::kFree : Verdict::kCollision, queried.is_near[i] != 0);
      if (is_free == (queried.truth[i] != 0)) add_fault(is_free ? "missed" : "extra", i);
    });
    ++made;
  }
  tally.expect_telling();
}

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

Edge make_edge(CheckerScene& scene, Random& random,
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

EdgeRequest random_request(Random& random) {
  EdgeRequest request{.first = random.chance(0.5)};
  if (random.chance(0.3)) request.resolution = random.magnitude(1e-6, 0.1);
  if (random.chance(0.1)) {
    request.max_configurations = static_cast<std::uint64_t>(random.whole(0, 60));
  }
  return request;
}

// What a result says has to be so wherever it is sampled.
class EdgeJudge {
 public:
  EdgeJudge(Tally& tally, CheckerScene& scene, const Edge& edge, const EdgeResult& result)
      : tally_(tally), scene_(scene), edge_(edge), result_(result) {}

  void run(const std::string& place) {
    place_ = place;
    tally_.count(result_.verdict, edge_.is_near);
    const int steps = tally_.cases % 200 == 0 ? 5000 : 100;
    for (int i = 0; i <= steps; ++i) sample(static_cast<double>(i) / steps);
    sample_around(edge_.meeting);
    sample_around(std::max(0.0, std::nextafter(result_.free_until, 0.0)));
    if (tally_.cases % 8 == 0) sample_around(nearest());
    if (result_.verdict != Verdict::kCollision) return;
    go_to(result_.contact_at);
    if (!scene_.touches(at_)) tally_.add_fault("no contact at contact_at, " + text());
  }

 private:
  std::string text() const {
    return place_ + " from" + to_text(edge_.from) + " to" + to_text(edge_.to);
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
    tally_.add_fault("contact is missed at t =" + to_text(std::span(&t, 1)) + ", " + text());
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
  CheckerScene& scene_;
  const Edge& edge_;
  const EdgeResult& result_;
  std::string place_{};
  std::vector<double> at_{};
  bool is_missed_ = false;
};

TEST(ManyEdges, AreFreeWhereTheyAreCalledSo) {
  Tally any{"edges, any contact"}, first{"edges, first contact"};
  const auto edges = static_cast<std::uint64_t>(scaled(2'300));
  for (int n = 0; any.cases + first.cases < edges; ++n) {
    Random random(seeded(7'000'021) + static_cast<std::uint64_t>(n));
    const auto scene = make_scene(random);
    if (!scene) continue;
    const std::vector<InstructionSet> sets = instruction_sets();
    const RobotChecker checker =
        scene->scene().snapshot({.instructions = sets[random.index(sets.size())]});
    RobotChecker::Scratch scratch(checker);
    std::optional<CheckerScene::Border> border;
    for (int i = 0; i < 48; ++i) {
      if (i % 8 == 0) border = scene->find_border(random);
      const Edge edge = make_edge(*scene, random, border);
      const EdgeRequest request = random_request(random);
      if (!scene->in_filter_range(edge.from) || !scene->in_filter_range(edge.to)) continue;
      const EdgeResult result = checker.check_edge(edge.from, edge.to, scratch, request);
      EdgeJudge(request.first ? first : any, *scene, edge, result)
          .run("scene " + std::to_string(n) + ", edge " + std::to_string(i));
    }
  }
  any.expect_telling();
  first.expect_telling();
}

}  // namespace
}  // namespace spherule::test
