// SPDX-License-Identifier: BSD-3-Clause
// Configurations of a RobotChecker, asked one by one and all at once with every instruction set:
// among sphere trees against all pairs of spheres in exact arithmetic, in scenes of all kinds of
// obstacles against the canonical tests of all pairs, one by one.
#include "tests/soak/robot_scenes.h"
#include "tests/soak/scale.h"
#include "tests/soak/tally.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

constexpr std::size_t kConfigurations = 251;      // of a scene: no whole number of lanes
constexpr std::size_t kTreeConfigurations = 256;  // the same among trees
constexpr double kNear = 0.6;                     // of these, some find no obstacle in their way

// Configurations, one behind the other, and what is known of each.
struct QueriedConfigurations {
  std::vector<double> positions;
  std::vector<std::uint8_t> is_near, truth;

  std::span<const double> operator[](std::size_t i) const {
    const std::size_t variables = positions.size() / truth.size();
    return std::span(positions).subspan(i * variables, variables);
  }
};

// As on a path or shuffled.
QueriedConfigurations make_configurations(TreeScene& scene, SoakRandom& random) {
  QueriedConfigurations made;
  const bool is_path = random.chance(0.5);
  std::vector<double> last = scene.anywhere(random);
  for (std::size_t i = 0; i < kTreeConfigurations; ++i) {
    std::vector<double> next = is_path ? last : scene.anywhere(random);
    if (is_path) {
      for (double& position : next) position += random.between(-0.01, 0.01);
    }
    last = next;
    const bool is_near = random.chance(kNear) && scene.bring_to_gap(next, random.small_gap());
    if (!is_near) next = last;
    made.positions.insert(made.positions.end(), next.begin(), next.end());
    made.is_near.push_back(is_near ? 1 : 0);
    made.truth.push_back(scene.touches(next) ? 1 : 0);
  }
  return made;
}

// Anywhere, on paths, and around where contact begins, at gaps of all orders of magnitude.
QueriedConfigurations make_configurations(CheckerScene& scene, SoakRandom& random) {
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

TEST(ManyConfigurations, AmongTreesAreAnsweredAlikeAndRight) {
  Tally tally{"robots among trees"};
  SoakRandom random(seeded(7));
  const int scenes = scaled(16);
  for (int n = 0; n < scenes; ++n) {
    TreeScene scene(random);
    const QueriedConfigurations queried = make_configurations(scene, random);
    std::vector<std::uint8_t> first;
    query(scene.scene(), queried, [&](std::size_t i, bool is_free) {
      tally.count(is_free ? Verdict::kFree : Verdict::kCollision, queried.is_near[i] != 0);
      const auto fault = [&](const char* what) {
        tally.add_fault(std::string(what) + ", configuration " + to_text(queried[i]));
      };
      if (is_free && queried.truth[i] != 0) fault("missed");
      if (!is_free && queried.truth[i] == 0 &&
          scene.gap(queried[i]).lower > scene.slack(queried[i])) {
        fault("beyond the slack");
      }
      // One set of instructions must not answer differently from another.
      if (first.size() <= i) first.push_back(is_free ? 1 : 0);
      if (is_free != (first[i] != 0)) fault("another answer");
    });
  }
  tally.expect_telling();
}

TEST(ManyConfigurations, InScenesAreAnsweredAsByTheCanonicalTests) {
  Tally tally{"robots in scenes"};
  const int scenes = scaled(80);
  for (int n = 0, made = 0; made < scenes; ++n) {
    SoakRandom random(seeded(7'000'021) + static_cast<std::uint64_t>(n));
    CheckerScene scene(random);
    if (scene.pair_count() == 0) continue;
    // Few of those that touch everywhere or nowhere.
    if (!scene.find_border(random) && !random.chance(0.1)) continue;
    const QueriedConfigurations queried = make_configurations(scene, random);
    query(scene.scene(), queried, [&](std::size_t i, bool is_free) {
      tally.count(is_free ? Verdict::kFree : Verdict::kCollision, queried.is_near[i] != 0);
      if (is_free != (queried.truth[i] != 0)) return;
      tally.add_fault((is_free ? "missed, scene " : "extra, scene ") + std::to_string(n) +
                      ", configuration " + to_text(queried[i]));
    });
    ++made;
  }
  tally.expect_telling();
}

}  // namespace
}  // namespace spherule::test
