// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "robot/model/shared_work.h"
#include "spheretree/build.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

// Many configurations a call, where there is too much to remember. That the answers are those of
// exact queries, whatever the order: tests/soak/robots_test.cpp.

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

// Configurations shared out among threads: the verdicts and the errors of one thread.

namespace spherule::test::robot_threads_test {
namespace {

// What robot_checker.cpp shares out.
constexpr std::size_t kPiece = 512;
constexpr std::size_t kFewestShared = 4096;

std::vector<RobotChecker::Scratch> scratches(const ObstacleChecker& checker, std::size_t count) {
  std::vector<RobotChecker::Scratch> result;
  for (std::size_t i = 0; i < count; ++i) result.emplace_back(checker);
  return result;
}

// In small steps, with a jump now and then.
std::vector<double> random_path(Random& random, const RobotModel& robot, std::size_t count) {
  std::vector<double> path;
  std::vector<double> at = random_configuration(random, robot, 3.2);
  for (std::size_t i = 0; i < count; ++i) {
    if (random.whole(0, 99) == 0) at = random_configuration(random, robot, 3.2);
    for (double& position : at) position += random.between(-0.01, 0.01);
    path.insert(path.end(), at.begin(), at.end());
  }
  return path;
}

TEST(RobotThreads, VerdictsAreThoseOfOneThread) {
  Random random(seeded(71));
  std::size_t hits = 0;
  std::size_t free = 0;
  for (int i = 0; i < scaled(40, 6); ++i) {
    const RobotModel robot = random_robot_with_trees(random, 0.3);
    const auto variables = static_cast<std::size_t>(robot.variable_count());
    if (variables == 0) continue;
    const ObstacleChecker checker(robot, random_obstacles(random),
                                  {.world_from_root = random_root(random, 1.0)});
    // About the ends of pieces and of blocks, and anywhere; some are shared out, some are not.
    constexpr std::size_t kLongest = kFewestShared + 3 * kPiece;
    const std::size_t sizes[] = {0,
                                 17,
                                 kPiece + 1,
                                 kFewestShared - 1,
                                 kFewestShared,
                                 kFewestShared + kPiece - 3,
                                 kFewestShared + kPiece + 1,
                                 static_cast<std::size_t>(random.whole(
                                     static_cast<int>(kFewestShared), static_cast<int>(kLongest)))};
    const std::vector<double> path = random_path(random, robot, kLongest);
    std::vector<RobotChecker::Scratch> seven =
        scratches(checker, 7);  // what they remember is no matter
    for (const std::size_t size : sizes) {
      ASSERT_LE(size * variables, path.size());
      const auto configurations = std::span(path).first(size * variables);
      RobotChecker::Scratch scratch(checker);
      std::vector<std::uint8_t> expected(size);
      checker.collides(configurations, scratch, expected);
      for (const std::uint8_t verdict : expected) (verdict == 1 ? hits : free) += 1;
      for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
        std::vector<std::uint8_t> verdicts(size, 2);
        checker.collides(configurations, std::span(seven).first(threads), verdicts);
        ASSERT_EQ(verdicts, expected) << i << ' ' << size << ' ' << threads;
      }
    }
  }
  EXPECT_GT(hits, static_cast<std::size_t>(effort(10000, 1000)));
  EXPECT_GT(free, static_cast<std::size_t>(effort(10000, 1000)));
}

// One that slides along x and touches from 0.9 to 1.1.
ObstacleChecker slide() {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .axis = {1, 0, 0}});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 0.05));
  return ObstacleChecker(robot, {{one_sphere_tree({1, 0, 0}, 0.05), Pose()}});
}

// What is thrown is what one thread would meet first, whichever thread comes to which first.
TEST(RobotThreads, ErrorsAreThoseOfOneThread) {
  const ObstacleChecker checker = slide();
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  constexpr double kTooFar = 1e17;
  const auto error_of = [&](const std::vector<double>& path, std::size_t threads) -> std::string {
    std::vector<RobotChecker::Scratch> some = scratches(checker, threads);
    std::vector<std::uint8_t> verdicts(path.size());
    try {
      if (threads == 0) {
        RobotChecker::Scratch scratch(checker);
        checker.collides(path, scratch, verdicts);
      } else {
        checker.collides(path, some, verdicts);
      }
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  std::vector<double> path(kFewestShared + 3 * kPiece - 5, 0.5);  // long enough to be shared out
  EXPECT_EQ(error_of(path, 3), "");
  std::set<std::string> errors;
  for (const std::size_t first : {std::size_t{3}, 3 * kPiece + 7, path.size() - 1}) {
    for (const auto& [at_first, later] : {std::pair(kNoNumber, kTooFar), {kTooFar, kNoNumber}}) {
      std::vector<double> bad = path;
      for (std::size_t i = first; i < bad.size(); i += kPiece) bad[i] = later;
      bad[first] = at_first;
      const std::string expected = error_of(bad, 0);
      EXPECT_NE(expected, "");
      errors.insert(expected);
      for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
        EXPECT_EQ(error_of(bad, threads), expected) << first << ' ' << threads;
      }
    }
  }
  EXPECT_EQ(errors.size(), 2U);
}

TEST(RobotThreads, RefusesWhatDoesNotFit) {
  const ObstacleChecker checker = slide();
  std::vector<RobotChecker::Scratch> two = scratches(checker, 2);
  std::vector<std::uint8_t> verdicts(2);
  EXPECT_THROW(checker.collides(std::vector<double>{0.0}, two, verdicts), Error);
  EXPECT_THROW(
      checker.collides(std::vector<double>{0.0, 1.0}, std::span<RobotChecker::Scratch>(), verdicts),
      Error);
  checker.collides(std::vector<double>{0.0, 1.0}, two, verdicts);
  EXPECT_EQ(verdicts, (std::vector<std::uint8_t>{0, 1}));
  checker.collides({}, two, {});
}

TEST(RobotThreads, RefusesTheScratchOfAnother) {
  const ObstacleChecker checker = slide();
  std::vector<RobotChecker::Scratch> own = scratches(checker, 1);
  std::vector<RobotChecker::Scratch> other = scratches(slide(), 2);
  const std::vector<double> q = {0.0};
  std::vector<std::uint8_t> verdicts(1);
  EXPECT_NO_THROW((void)checker.explain(q, own[0]));
  EXPECT_THROW((void)checker.collides(q, other[0]), Error);
  EXPECT_THROW((void)checker.within(q, 0.1, other[0]), Error);
  EXPECT_THROW((void)checker.explain(q, other[0]), Error);
  EXPECT_THROW((void)checker.check_edge(q, q, other[0]), Error);
  EXPECT_THROW(checker.collides(q, other[0], verdicts), Error);
  EXPECT_THROW(checker.collides(q, other, verdicts), Error);
  // Also where so few are not shared out, so that only the first scratch is used.
  own.push_back(std::move(other[1]));
  EXPECT_THROW(checker.collides(q, own, verdicts), Error);
}

TEST(SharedWork, DoesEachPieceOnceAndLetsNoTwoShareAWorker) {
  for (const std::size_t pieces : {0U, 1U, 2U, 5U, 1000U}) {
    for (const std::size_t workers : {1U, 2U, 3U, 7U}) {
      std::vector<std::atomic<int>> done(pieces);
      std::vector<std::atomic<int>> busy(workers);
      std::atomic<bool> shared = false;
      internal::share_work(pieces, workers, [&](std::size_t worker, std::size_t piece) {
        if (busy[worker].fetch_add(1) != 0) shared = true;
        done[piece].fetch_add(1);
        busy[worker].fetch_sub(1);
      });
      for (const auto& times : done) EXPECT_EQ(times.load(), 1);
      EXPECT_FALSE(shared.load());
    }
  }
}

TEST(SharedWork, OnePieceStaysOnTheCallersThread) {
  const std::thread::id caller = std::this_thread::get_id();
  internal::share_work(1, 7, [&](std::size_t worker, std::size_t) {
    EXPECT_EQ(worker, 0U);
    EXPECT_EQ(std::this_thread::get_id(), caller);
  });
}

// Two pieces throw, now the one first, now the other.
TEST(SharedWork, ThrowsWhatTheFirstPieceThrows) {
  for (int i = 0; i < 100; ++i) {
    std::atomic<int> begun = 0;
    std::atomic<int> thrown = 0;
    std::atomic<int> running = 0;
    const std::size_t last_to_throw = i % 2 == 0 ? 10 : 11;
    try {
      internal::share_work(100, 2, [&](std::size_t, std::size_t piece) {
        ++running;
        if (piece >= 10) ++begun;
        while (piece >= 10 && begun < 2) std::this_thread::yield();
        if (piece == last_to_throw) {
          while (thrown == 0) std::this_thread::yield();
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        --running;
        if (piece < 10) return;
        ++thrown;
        throw std::runtime_error(std::to_string(piece));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "10");
    }
    EXPECT_EQ(running.load(), 0);
    EXPECT_EQ(thrown.load(), 2);
  }
}

}  // namespace
}  // namespace spherule::test::robot_threads_test
