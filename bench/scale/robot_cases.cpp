// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scale/cases.h"
#include "bench/scale/scale_robot.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr std::size_t kConfigurations = 256;  // of a scene
constexpr double kNear = 0.6;                 // of these, some find no obstacle in their way

struct NamedInstructions {
  InstructionSet set;
  const char* name;
};
constexpr std::array<NamedInstructions, 3> kInstructions{{{InstructionSet::kPortable, "portable"},
                                                          {InstructionSet::kAvx2, "avx2"},
                                                          {InstructionSet::kAvx512, "avx512"}}};

struct Configurations {
  std::vector<double> positions;  // one behind the other
  std::vector<std::uint8_t> is_near, truth;
};

// As on a path or shuffled.
Configurations make_configurations(ScaleRobot& scene, SceneRandom& random) {
  Configurations made;
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

void check_configurations(std::uint64_t configurations, std::uint64_t seed, ScaleReport& report) {
  struct Rows {
    InstructionSet set;
    Tally* single;
    Tally* batch;
  };
  std::vector<Rows> rows;
  for (const auto& [set, name] : kInstructions) {
    if (!is_available(set)) continue;
    const std::string robot = std::string("robot, ") + name;
    Tally& single = report.add(robot + ", single");
    rows.push_back({set, &single, &report.add(robot + ", batch")});
  }

  SceneRandom random(seed);
  std::vector<std::uint8_t> batch(kConfigurations), first;
  for (std::uint64_t done = 0; done < configurations; done += kConfigurations) {
    ScaleRobot scene(random);
    const Configurations asked = make_configurations(scene, random);
    const auto variables = static_cast<std::size_t>(scene.robot().variable_count());
    const auto judge = [&](Tally& tally, std::size_t i, bool said) {
      const std::span<const double> configuration(&asked.positions[i * variables], variables);
      tally.count(said ? Verdict::kCollision : Verdict::kFree, asked.is_near[i] != 0);
      if (!said && asked.truth[i] != 0) {
        ++tally.missed;
        report.failure(tally, "missed at case " + std::to_string(tally.cases));
      } else if (said && asked.truth[i] == 0) {
        tally.count_extra(scene.gap(configuration).lower, scene.slack(configuration));
      }
      // One set of instructions must not answer differently from another.
      if (first.size() <= i) {
        first.push_back(said ? 1 : 0);
      } else if (said != (first[i] != 0)) {
        ++tally.beyond;
        report.failure(tally, "another answer at case " + std::to_string(tally.cases));
      }
    };
    first.clear();
    for (const Rows& row : rows) {
      const RobotTreeChecker checker(scene.robot(), scene.obstacles(), {.instructions = row.set});
      RobotTreeChecker::Scratch scratch(checker);
      for (std::size_t i = 0; i < kConfigurations; ++i) {
        const std::span<const double> configuration(&asked.positions[i * variables], variables);
        judge(*row.single, i, checker.collides(configuration, scratch));
      }
      checker.collides(asked.positions, scratch, batch);
      for (std::size_t i = 0; i < kConfigurations; ++i) judge(*row.batch, i, batch[i] != 0);
    }
    report.progress("configurations", done, configurations);
  }
}

}  // namespace spherule
