// SPDX-License-Identifier: BSD-3-Clause
// Many configurations a call, where there is too much to remember. That the answers are those of
// exact queries, whatever the order: tests/soak/configurations_test.cpp.

#include "base/error.h"
#include "spheretree/build.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace spherule::test {
namespace {

// Configurations one behind the other.
struct Path {
  std::vector<double> positions{};
  std::size_t variables = 0;

  std::size_t size() const { return variables == 0 ? 0 : positions.size() / variables; }
  std::span<const double> operator[](std::size_t i) const {
    return std::span(positions).subspan(i * variables, variables);
  }
  void add(const std::vector<double>& configuration) {
    positions.insert(positions.end(), configuration.begin(), configuration.end());
  }
};

std::vector<std::uint8_t> verdicts(const ObstacleChecker& checker, const Path& path,
                                   RobotChecker::Scratch& scratch) {
  std::vector<std::uint8_t> result(path.size());
  checker.collides(path.positions, scratch, result);
  return result;
}

// The same by the exact queries.
std::vector<std::uint8_t> answers(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                                  const Path& path, const ObstacleOptions& options) {
  std::vector<std::uint8_t> result;
  for (std::size_t k = 0; k < path.size(); ++k) {
    result.push_back(answer(robot, obstacles, path[k], options) ? 1 : 0);
  }
  return result;
}

// Many small spheres in the way of a search make it run out of room; a block with numbers far out
// of range among others is answered as well.
TEST(RobotBatch, AnswersWhereThereIsTooMuchToRemember) {
  Random random(43);
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", std::make_shared<const SphereTree>(
                          build_tree(random_spheres(random, 3000, 0.5, 0.01))));
  const std::vector<PlacedTree> obstacles = {
      {std::make_shared<const SphereTree>(build_tree(random_spheres(random, 3000, 0.5, 1e-4))),
       Pose::from_translation({0.9, 0.0, 0.0})}};
  Path path{.variables = 1};
  for (int i = 0; i < 100; ++i) path.add({0.001 * i + (i % 23 == 7 ? 628.3 : 0.0)});
  const std::vector<std::uint8_t> expected = answers(robot, obstacles, path, {});
  for (const InstructionSet set : instruction_sets()) {
    const ObstacleChecker checker(robot, obstacles, {.instructions = set});
    RobotChecker::Scratch scratch(checker);
    EXPECT_EQ(verdicts(checker, path, scratch), expected);
  }
}

// A sphere inside a shell of small spheres overlaps every inner sphere of the shell's tree, but
// only one sphere: more waits to be searched than there is room for, and nothing of it may be
// forgotten.
TEST(RobotBatch, NothingThatWaitsIsForgotten) {
  std::vector<Sphere> shell;
  constexpr int kCount = 5000;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount;
    const double turn = 2.399963229728653 * i;
    const double r = std::sqrt(1.0 - z * z);
    shell.push_back({{r * std::cos(turn), r * std::sin(turn), z}, 1e-3});
  }
  RobotModel robot("base");
  robot.add_link("slide", "base", {.name = "slide", .type = JointType::kPrismatic});
  robot.attach("slide", std::make_shared<const SphereTree>(
                            build_tree(std::vector<Sphere>{{{0, 0, 0}, 0.95}, {{2, 0, 0}, 0.01}})));
  shell.push_back({{0, 5, 0}, 3.9});  // only the sphere around all of the body overlaps it
  Path path{.variables = 1};
  for (int i = 0; i < 32; ++i) path.add({1e-4 * i});
  for (int at = 0; at < kCount; at += effort(97, 997)) {
    std::vector<Sphere> spheres = shell;
    if (at > 0) spheres[static_cast<std::size_t>(at)].radius = 0.06;
    const std::vector<PlacedTree> obstacles = {
        {std::make_shared<const SphereTree>(build_tree(spheres)), Pose()}};
    for (const InstructionSet set : instruction_sets()) {
      const ObstacleChecker checker(robot, obstacles, {.instructions = set});
      RobotChecker::Scratch scratch(checker);
      const std::vector<std::uint8_t> expected(path.size(), at > 0 ? 1 : 0);
      EXPECT_EQ(verdicts(checker, path, scratch), expected) << at;
    }
  }
}

TEST(RobotBatch, RefusesBadInput) {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  const ObstacleChecker checker(robot, {{one_sphere_tree({0, 1, 0}, 0.1), Pose()}});
  RobotChecker::Scratch scratch(checker);
  std::vector<std::uint8_t> two(2);
  EXPECT_THROW(checker.collides(std::vector<double>{0.0}, scratch, two), Error);
  EXPECT_THROW(checker.collides(std::vector<double>{0.0, 0.0, 0.0}, scratch, two), Error);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(checker.collides(std::vector<double>{0.0, bad}, scratch, two), Error) << bad;
  }
  checker.collides({}, scratch, {});
  checker.collides(std::vector<double>{0.0, 1.5707963}, scratch, two);
  EXPECT_EQ(two, (std::vector<std::uint8_t>{0, 1}));
}

}  // namespace
}  // namespace spherule::test
