// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/cases.h"
#include "tests/soak/checker_rows.h"
#include "tests/soak/soak_robot.h"

#include <cstdint>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr std::size_t kConfigurations = 256;  // of a scene
constexpr double kNear = 0.6;                 // of these, some find no obstacle in their way

// As on a path or shuffled.
QueriedConfigurations make_configurations(SoakRobot& scene, SceneRandom& random) {
  QueriedConfigurations made;
  const bool is_path = random.chance(0.5);
  std::vector<double> last = scene.anywhere(random);
  for (std::size_t i = 0; i < kConfigurations; ++i) {
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

}  // namespace

std::uint64_t check_configurations(std::uint64_t configurations, std::uint64_t seed,
                                   SoakReport& report) {
  const std::vector<CheckerRows> rows = add_checker_rows("robot", report);
  SceneRandom random(seed);
  std::vector<std::uint8_t> first;
  std::uint64_t done = 0;
  for (; done < configurations; done += kConfigurations) {
    SoakRobot scene(random);
    const QueriedConfigurations queried = make_configurations(scene, random);
    const auto judge = [&](Tally& tally, std::size_t i, bool is_free) {
      const std::span<const double> configuration = queried.configuration(i);
      tally.count(is_free ? Verdict::kFree : Verdict::kCollision, queried.is_near[i] != 0);
      if (is_free && queried.truth[i] != 0) {
        report.add_fault(tally, Fault::kMissed, "configuration " + to_text(configuration));
      } else if (!is_free && queried.truth[i] == 0 &&
                 tally.count_extra(scene.gap(configuration).lower, scene.slack(configuration))) {
        report.add_fault(tally, Fault::kCrossed, "slack, configuration " + to_text(configuration));
      }
      // One set of instructions must not answer differently from another.
      if (first.size() <= i) {
        first.push_back(is_free ? 1 : 0);
      } else if (is_free != (first[i] != 0)) {
        report.add_fault(tally, Fault::kOther,
                         "another answer, configuration " + to_text(configuration));
      }
    };
    first.clear();
    check_rows(scene.scene(), rows, queried, judge);
  }
  return done;
}

}  // namespace spherule
