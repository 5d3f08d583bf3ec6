// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/trajectory_file.h"

#include "base/error.h"
#include "tests/robot/refusals.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

// Joints a, b (mimics a), fixed and c: two variables.
RobotModel small_robot() {
  RobotModel robot("base");
  robot.add_link("1", "base", turning(-1.0, 1.0, "a"));
  robot.add_link("2", "1", sliding(-1.0, 1.0, "b"));
  robot.add_link("3", "2", {.name = "fixed"});
  robot.add_link("4", "3", wheel("c"));
  robot.mimic("b", "a", 0.5);
  return robot;
}

class TrajectoryFileTest : public testing::Test {
 protected:
  Trajectory read(std::string_view text) const {
    return read_trajectory(folder_.write("path.csv", text), robot_);
  }
  std::string fault(std::string_view text) const {
    return refusal_of(text,
                      [&](const std::filesystem::path& file) { read_trajectory(file, robot_); });
  }

  const TempDir folder_;
  const RobotModel robot_ = small_robot();
};

// Angles of joints that turn; lengths stay as they are, and so do columns that are passed over.
TEST_F(TrajectoryFileTest, InDegrees) {
  RobotModel robot = small_robot();
  robot.add_link("5", "4", sliding(-1.0, 1.0, "d"));
  const auto read_degrees = [&](std::string_view text) {
    return read_trajectory(folder_.write("path.csv", text), robot, AngleUnit::kDegrees);
  };
  const Trajectory path = read_degrees("d time c a\n0.5 9 180 -90\n90 7 1e-3 0\n");
  ASSERT_EQ(path.size(), 2u);
  const std::vector<double> expected = {-kPi / 2.0, kPi, 0.5, 0.0, 1e-3 / 180.0 * kPi, 90.0};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(path.positions[i], expected[i], 4e-16 * std::abs(expected[i])) << i;
  }
  EXPECT_EQ(read_degrees("90 0 0\n").positions[0], kPi / 2.0);
}

TEST_F(TrajectoryFileTest, WithoutAHeader) {
  const Trajectory path = read("\xEF\xBB\xBF# a comment\n0.5, -1e-3\n\n 2;3 # end\r\n4\t5");
  EXPECT_EQ(path.width, 2u);
  EXPECT_EQ(path.size(), 3u);
  EXPECT_EQ(path.positions, (std::vector<double>{0.5, -1e-3, 2, 3, 4, 5}));
  EXPECT_EQ(path.lines, (std::vector<std::size_t>{2, 4, 5}));
  EXPECT_EQ(path.configuration(1)[1], 3.0);
}

TEST_F(TrajectoryFileTest, WithAHeaderInAnyOrder) {
  const Trajectory path = read("time,c,a\n0,1,2\n0.1,3,4\n");
  EXPECT_EQ(path.positions, (std::vector<double>{2, 1, 4, 3}));
  EXPECT_EQ(path.lines, (std::vector<std::size_t>{2, 3}));
}

TEST_F(TrajectoryFileTest, JointsThatAreLeftOutStandAsInTheOtherConfiguration) {
  const std::vector<double> otherwise = {0.25, -0.75};
  const auto read_some = [&](std::string_view text) {
    return read_trajectory(folder_.write("path.csv", text), robot_, AngleUnit::kDegrees, otherwise);
  };
  const Trajectory path = read_some("time,c\n0,180\n1,90\n");
  EXPECT_EQ(path.positions, (std::vector<double>{0.25, kPi, 0.25, kPi / 2.0}));
  EXPECT_EQ(path.others, std::vector<std::string>{"a"});
  EXPECT_TRUE(path.has_header);
  EXPECT_TRUE(read_some("a,c\n1,2\n").others.empty());
  EXPECT_FALSE(read_some("1,2\n").has_header);
  EXPECT_EQ(reason_of([&] { read_some("1\n"); }).substr(0, 39),
            "line 1: has 1 numbers instead of 2: a, ");
  EXPECT_EQ(reason_of([&] { read_some("time\n1\n"); }), "line 1: it names no joint of the robot");
  EXPECT_EQ(fault("c\n1\n"), "line 1: joint 'a' is missing");
  EXPECT_EQ(reason_of([&] {
              read_trajectory(folder_.write("path.csv", "c\n1\n"), robot_, AngleUnit::kRadians,
                              std::vector{1.0});
            }),
            "it is not of this robot: it has 1 numbers");
}

TEST_F(TrajectoryFileTest, LinesEndWithEitherCharacterOrBoth) {
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    const Trajectory path = read("time,c,a" + end + "0,1,2" + end + end + "0.1,3,4" + end);
    EXPECT_EQ(path.positions, (std::vector<double>{2, 1, 4, 3}));
    EXPECT_EQ(path.lines, (std::vector<std::size_t>{2, 4}));
  }
}

// A column of that name is of the joint where there is one.
TEST_F(TrajectoryFileTest, AJointMayBeCalledTime) {
  RobotModel robot("base");
  robot.add_link("hand", "base", wheel("time"));
  const Trajectory path = read_trajectory(folder_.write("path.csv", "time\n0.5\n"), robot);
  EXPECT_EQ(path.positions, std::vector<double>{0.5});
}

TEST_F(TrajectoryFileTest, RefusesWithTheLine) {
  EXPECT_EQ(fault(""), "it has no configuration");
  EXPECT_EQ(fault("a,c\n"), "it has no configuration");
  EXPECT_EQ(
      fault("1,2\n3\n"),
      "line 2: has 1 numbers instead of 2: a, c; a first line of names says which joints they "
      "are");
  EXPECT_TRUE(fault("1,2\n\n3,4,5\n").starts_with("line 3: has 3 numbers instead of 2: a, c"));
  EXPECT_EQ(fault("time,a,c\n1,2\n"), "line 2: has 2 numbers instead of 3");
  EXPECT_EQ(fault("1,2\n3,x\n"), "line 2: 'x' is not a finite number");
  EXPECT_EQ(fault("1,2\n3,\n"), "line 2: '' is not a finite number");
  EXPECT_TRUE(fault("1,5;2\n").starts_with("line 1: has commas beside other separators"));
  EXPECT_TRUE(fault("1 2\n1 ,5 2\n").starts_with("line 2: has commas beside other separators"));
  EXPECT_EQ(fault("1,nan\n"), "line 1: 'nan' is not a finite number");
  EXPECT_EQ(fault("1,-inf\n"), "line 1: '-inf' is not a finite number");
  EXPECT_EQ(fault("1e400,2\n"), "line 1: '1e400' is not a finite number");
  EXPECT_EQ(fault("# path\n1,-1E+400\n"), "line 2: '-1E+400' is not a finite number");
  EXPECT_EQ(fault("+Infinity,2\n"), "line 1: '+Infinity' is not a finite number");
  EXPECT_EQ(fault("+-1,2\n"), "line 1: '+-1' is not a finite number");
  EXPECT_EQ(fault("1e400,c\n"), "line 1: the robot has no joint '1e400'");
  EXPECT_EQ(fault("1,2\n1e999,2\n"), "line 2: '1e999' is not a finite number");
  EXPECT_EQ(fault("a,d\n"), "line 1: the robot has no joint 'd'");
  EXPECT_EQ(fault("a,b,c\n"), "line 1: joint 'b' mimics another; leave it out");
  EXPECT_EQ(fault("a,fixed,c\n"), "line 1: joint 'fixed' is fixed and has no position");
  EXPECT_EQ(fault("a,c,a\n"), "line 1: joint 'a' is there twice");
  EXPECT_EQ(fault("a\n1\n"), "line 1: joint 'c' is missing");
  EXPECT_EQ(fault("a,c\n1,2\na,c\n"), "line 3: 'a' is not a finite number");
  EXPECT_THROW(read_trajectory(folder_.path() / "none.csv", robot_), Error);
  EXPECT_EQ(fault("time,a,c\n0,1,2\nnan,1,2\n"), "line 3: 'nan' is not a finite number");
  const std::filesystem::path path = folder_.write("path.csv", "1\n");
  EXPECT_EQ(reason_of([&] { read_trajectory(path, RobotModel()); }),
            "the robot has no joint that moves");
}

// An elbow of -2 to 2.5 rad, a slide of +-1 m, a finger that follows it at half its position within
// 0.4 m, and a wheel that turns without limits: three numbers.
RobotModel robot_of_all_kinds() {
  RobotModel robot("base");
  robot.add_link("forearm", "base", turning(-2.0, 2.5, "elbow"));
  robot.add_link("slider", "forearm", sliding(-1.0, 1.0, "slide"));
  robot.add_link("tip", "slider", sliding(-0.4, 0.4, "finger"));
  robot.add_link("disc", "slider", wheel("wheel"));
  robot.mimic("finger", "slide", 0.5);
  return robot;
}

// As lines 10, 20 and so on of a file.
Trajectory trajectory_of(const std::vector<std::vector<double>>& configurations) {
  Trajectory trajectory{.width = 3};
  for (const std::vector<double>& configuration : configurations) {
    trajectory.positions.insert(trajectory.positions.end(), configuration.begin(),
                                configuration.end());
    trajectory.lines.push_back(10 * (trajectory.size() + 1));
  }
  return trajectory;
}

TEST(OutsideLimits, AreCountedAndTheFirstIsNamed) {
  const RobotModel robot = robot_of_all_kinds();
  const auto outside = [&](const std::vector<std::vector<double>>& configurations) {
    return outside_limits(robot, trajectory_of(configurations));
  };
  EXPECT_EQ(outside({{2.5, 0.8, 9.0}, {-2.0, -0.8, -9.0}}).count, 0u) << "the limits are within";
  const OutsideLimits found = outside({{0, 0, 0}, {0, 0.9, 0}, {3, 0, 0}, {0, -2, 0}, {0, 0, 0}});
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.line, 20u);
  EXPECT_EQ(found.joint, "finger") << "0.9 is within those of the slide";
  EXPECT_FALSE(found.turns);
  EXPECT_EQ(found.position, 0.45);
  EXPECT_EQ(found.upper, 0.4);
  const OutsideLimits elbow = outside({{std::nextafter(2.5, 3.0), 0, 0}});
  EXPECT_EQ(elbow.count, 1u);
  EXPECT_EQ(elbow.joint, "elbow");
  EXPECT_TRUE(elbow.turns);
  EXPECT_EQ(elbow.lower, -2.0);
}

TEST(DegreesGuess, TellsDegreesFromRadians) {
  const RobotModel robot = robot_of_all_kinds();
  Random random(72);
  int told = 0;
  const int cases = effort(500, 100);
  for (int i = 0; i < cases; ++i) {
    // Large motions of all joints, in radians and in degrees.
    std::vector<std::vector<double>> radians, degrees;
    for (int k = 0; k < 20; ++k) {
      const std::vector<double> at = {random.between(-2.0, 2.5), random.between(-1.0, 1.0),
                                      random.between(-kPi, kPi)};
      radians.push_back(at);
      degrees.push_back({at[0] / kDegree, at[1], at[2] / kDegree});
    }
    EXPECT_FALSE(guess_degrees(robot, trajectory_of(radians)).looks_so);
    told += guess_degrees(robot, trajectory_of(degrees)).looks_so ? 1 : 0;
  }
  EXPECT_EQ(told, cases);
}

TEST(DegreesGuess, NeedsManyAnglesThatFitOnlySo) {
  const RobotModel robot = robot_of_all_kinds();
  const auto looks_so = [&](const std::vector<std::vector<double>>& configurations) {
    return guess_degrees(robot, trajectory_of(configurations)).looks_so;
  };
  EXPECT_TRUE(looks_so({{0, 0, 0}, {90, 0, 0}}));
  EXPECT_TRUE(looks_so({{0, 0, 180}, {0, 0, -720}}));
  EXPECT_FALSE(looks_so({{0, 0, 0}, {0, 100, 0}})) << "lengths are none";
  EXPECT_FALSE(looks_so({{200, 0, 0}, {90, 0, 0}})) << "beyond the limits as degrees, too";
  EXPECT_FALSE(looks_so({{2.6, 0, 0}, {2.7, 0, 0}})) << "slightly beyond, in radians";
  EXPECT_FALSE(looks_so({{1, 0, 7}, {2, 0, 8}, {1, 0, 3}, {2, 0, 0.1}, {2, 0, 0.1}}))
      << "a wheel that turns a little more than once";
  EXPECT_FALSE(looks_so({{0, 0, 721}})) << "a spindle";
  EXPECT_FALSE(looks_so({{0, 0, 0}}));
  const DegreesGuess guess =
      guess_degrees(robot, trajectory_of({{0, 0, 0}, {1, 0, 0}, {-90, 0, 3}, {45, 0.5, 120}}));
  EXPECT_TRUE(guess.looks_so);
  EXPECT_EQ(guess.angles, 5u);
  EXPECT_EQ(guess.beyond, 3u);
  EXPECT_EQ(guess.line, 30u);
  EXPECT_EQ(guess.joint, "elbow");
  EXPECT_EQ(guess.value, -90.0);
}

TEST(TurningMotions, AreThoseOfContinuousJoints) {
  const RobotModel robot = robot_of_all_kinds();
  const Trajectory path =
      trajectory_of({{-2, -1, 0}, {2.4, 1, 3}, {-2, 0, -3}, {0, 0, 4}, {0, 0, 4 - kPi}});
  const TurningMotions found = more_than_half_a_turn(robot, path);
  EXPECT_EQ(found.count, 2u);
  EXPECT_EQ(found.line, 20u);
  EXPECT_EQ(found.to_line, 30u);
  EXPECT_EQ(found.joint, "wheel");
  EXPECT_EQ(found.step, -6.0);
  EXPECT_NEAR(found.shorter, 2.0 * kPi - 6.0, 1e-14);
  const TurningMotions half = half_a_turn(robot, path);
  EXPECT_EQ(half.count, 1u);
  EXPECT_EQ(half.line, 40u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.1416}})).count, 1u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.1415}})).count, 1u);
  EXPECT_EQ(half_a_turn(robot, trajectory_of({{0, 0, 0}, {0, 0, 3.14}})).count, 0u);
  EXPECT_EQ(more_than_half_a_turn(robot, trajectory_of({{0, 0, 9}})).count, 0u);
}

}  // namespace
}  // namespace spherule::test
