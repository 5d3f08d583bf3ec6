// SPDX-License-Identifier: BSD-3-Clause
// Configurations of a RobotChecker: its answer is that of the canonical tests of all pairs, one by
// one, with every instruction set.
#include "tests/soak/cases.h"
#include "tests/soak/checker_rows.h"
#include "tests/soak/checker_scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr std::size_t kConfigurations = 251;  // of a scene: no whole number of lanes

// Anywhere, on paths, and around where contact begins, at gaps of all orders of magnitude.
QueriedConfigurations make_configurations(CheckerScene& scene, SceneRandom& random) {
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

}  // namespace

std::uint64_t check_checker_configurations(std::uint64_t configurations, std::uint64_t seed,
                                           SoakReport& report) {
  const std::vector<CheckerRows> rows = add_checker_rows("checker", report);
  std::uint64_t done = 0;
  for (std::uint64_t number = 0; done < configurations; ++number) {
    SceneRandom random(seed * 1'000'003 + number);
    CheckerScene scene(random);
    if (scene.pair_count() == 0) continue;
    // Few of those that touch everywhere or nowhere.
    if (!scene.find_border(random) && !random.chance(0.1)) continue;
    const QueriedConfigurations queried = make_configurations(scene, random);
    const auto judge = [&](Tally& tally, std::size_t i, bool is_free) {
      tally.count(is_free ? Verdict::kFree : Verdict::kCollision, queried.is_near[i] != 0);
      if (is_free != (queried.truth[i] != 0)) return;
      tally.extra += is_free ? 0 : 1;
      report.add_fault(tally, is_free ? Fault::kMissed : Fault::kOther,
                       "scene " + std::to_string(number) + ", configuration " +
                           to_text(queried.configuration(i)));
    };
    check_rows(scene.scene(), rows, queried, judge);
    done += kConfigurations;
  }
  return done;
}

}  // namespace spherule
