// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"
#include "tests/soak/tally.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Configurations, one behind the other, and what is known of each.
struct QueriedConfigurations {
  std::vector<double> positions;
  std::vector<std::uint8_t> is_near, truth;

  std::span<const double> configuration(std::size_t i) const {
    const std::size_t variables = positions.size() / truth.size();
    return std::span(positions).subspan(i * variables, variables);
  }
};

// The rows of a RobotChecker with an instruction set: one configuration a call, and all at once.
struct CheckerRows {
  InstructionSet set;
  Tally* single;
  Tally* batch;
};

// For each instruction set that this machine has; `name` stands before its name.
std::vector<CheckerRows> add_checker_rows(const std::string& name, SoakReport& report);

// Calls judge(tally, i, is_free) for each configuration and each row.
template <class Judge>
void check_rows(const RobotScene& scene, std::span<const CheckerRows> rows,
                const QueriedConfigurations& queried, const Judge& judge) {
  std::vector<std::uint8_t> free(queried.truth.size());
  for (const CheckerRows& row : rows) {
    const RobotChecker checker = scene.snapshot({.instructions = row.set});
    RobotChecker::Scratch scratch(checker);
    for (std::size_t i = 0; i < free.size(); ++i) {
      judge(*row.single, i, checker.check_config(queried.configuration(i), scratch));
    }
    checker.check_configs(queried.positions, scratch, free);
    for (std::size_t i = 0; i < free.size(); ++i) judge(*row.batch, i, free[i] != 0);
  }
}

}  // namespace spherule
