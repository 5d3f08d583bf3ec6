// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/kinematics.h"

#include "base/error.h"
#include "robot/check/robot_collision.h"
#include "robot/model/link_paths.h"
#include "robot/model/shortest_motion.h"
#include "spheretree/build.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>
#include <kdl/jntarray.hpp>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

// Forward kinematics against KDL, and its error bound against 100 digits.

namespace spherule::test {
namespace {

std::vector<Pose> poses_of(const RobotModel& robot, const std::vector<double>& configuration,
                           const Pose& root = {}) {
  std::vector<Pose> poses;
  forward_kinematics(robot, configuration, poses, root);
  return poses;
}

// KDL has the joint first and the fixed frame behind it. So every joint of ours is two segments:
// one fixed, with the joint's origin, and one that moves and has no frame of its own.
KDL::Tree kdl_tree(const RobotModel& robot) {
  KDL::Tree tree(robot.links()[0].name);
  for (const Joint& joint : robot.joints()) {
    const Eigen::Quaterniond q = joint.parent_from_joint.rotation();
    const Eigen::Vector3d t = joint.parent_from_joint.translation();
    const KDL::Vector axis(joint.axis.x(), joint.axis.y(), joint.axis.z());
    const KDL::Frame origin(KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()),
                            KDL::Vector(t.x(), t.y(), t.z()));
    const KDL::Joint moving =
        joint.type == JointType::kFixed
            ? KDL::Joint(joint.name, KDL::Joint::None)
            : KDL::Joint(
                  joint.name, KDL::Vector::Zero(), axis,
                  joint.type == JointType::kRevolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
    const std::string& parent = robot.links()[static_cast<std::size_t>(joint.parent_link)].name;
    const std::string& child = robot.links()[static_cast<std::size_t>(joint.child_link)].name;
    tree.addSegment(
        KDL::Segment(child + "_origin", KDL::Joint(child + "_origin", KDL::Joint::None), origin),
        parent);
    tree.addSegment(KDL::Segment(child, moving), child + "_origin");
  }
  return tree;
}

void compare_with_kdl(bool branching) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const RobotModel robot = random_robot(random, random.whole(1, 12), branching);
    if (robot.variable_count() == 0) continue;  // KDL requires a position even then
    // A copy of a KDL tree numbers its joints depth-first, whatever the numbers of the original,
    // and the solver keeps a copy; a copy of a copy keeps the numbers.
    const KDL::Tree original = kdl_tree(robot);
    const KDL::Tree tree(original);
    ASSERT_EQ(tree.getNrOfJoints(), static_cast<unsigned>(robot.variable_count()));
    KDL::TreeFkSolverPos_recursive solver(tree);
    const std::vector<double> configuration = random_configuration(random, robot, 3.0);
    KDL::JntArray positions(tree.getNrOfJoints());
    for (const Joint& joint : robot.joints()) {
      if (joint.variable < 0) continue;
      const std::string& child = robot.links()[static_cast<std::size_t>(joint.child_link)].name;
      positions(tree.getSegment(child)->second.q_nr) =
          configuration[static_cast<std::size_t>(joint.variable)];
    }
    const std::vector<Pose> poses = poses_of(robot, configuration);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      KDL::Frame frame;
      ASSERT_GE(solver.JntToCart(positions, frame, robot.links()[link].name), 0);
      for (int row = 0; row < 3; ++row) {
        ASSERT_NEAR(poses[link].translation()[row], frame.p[row], 1e-11);
        for (int column = 0; column < 3; ++column) {
          ASSERT_NEAR(poses[link].matrix()(row, column), frame.M(row, column), 1e-12);
        }
      }
    }
  }
}

TEST(Kinematics, AgreesWithKdlOnChains) {
  compare_with_kdl(false);
}
TEST(Kinematics, AgreesWithKdlOnTrees) {
  compare_with_kdl(true);
}

// A quaternion and a translation in 100 digits.
struct ExactPose {
  std::array<Real, 4> q;  // w x y z, unit
  Vector<Real> t;
};

Vector<Real> rotate(const std::array<Real, 4>& q, const Vector<Real>& p) {
  const auto& [w, x, y, z] = q;
  return {(w * w + x * x - y * y - z * z) * p[0] + 2 * (x * y - w * z) * p[1] +
              2 * (x * z + w * y) * p[2],
          2 * (x * y + w * z) * p[0] + (w * w - x * x + y * y - z * z) * p[1] +
              2 * (y * z - w * x) * p[2],
          2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] +
              (w * w - x * x - y * y + z * z) * p[2]};
}

Vector<Real> image(const ExactPose& pose, const Vector<Real>& p) {
  const Vector<Real> r = rotate(pose.q, p);
  return {r[0] + pose.t[0], r[1] + pose.t[1], r[2] + pose.t[2]};
}

std::array<Real, 4> product(const std::array<Real, 4>& p, const std::array<Real, 4>& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

ExactPose exact_pose(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  std::array<Real, 4> result = {q.w(), q.x(), q.y(), q.z()};
  const Real length = sqrt(Real(result[0] * result[0] + result[1] * result[1] +
                                result[2] * result[2] + result[3] * result[3]));
  for (Real& component : result) component /= length;
  return {result, exact<Real>(pose.translation())};
}

ExactPose exact_motion(const Joint& joint, const Real& position) {
  const Vector<Real> axis = exact<Real>(joint.axis);
  const Real length = sqrt(squared_distance(axis, Vector<Real>{0, 0, 0}));
  if (joint.type == JointType::kFixed) return {{1, 0, 0, 0}, {0, 0, 0}};
  if (joint.type == JointType::kPrismatic) {
    const Real step = position / length;
    return {{1, 0, 0, 0}, {axis[0] * step, axis[1] * step, axis[2] * step}};
  }
  const Real half = position / 2;
  const Real s = sin(half) / length;
  return {{cos(half), axis[0] * s, axis[1] * s, axis[2] * s}, {0, 0, 0}};
}

ExactPose compose(const ExactPose& a, const ExactPose& b) {
  return {product(a.q, b.q), image(a, b.t)};
}

// Of every link, of the mechanism that the model stores.
std::vector<ExactPose> exact_poses_of(const RobotModel& robot,
                                      const std::vector<double>& configuration, const Pose& root) {
  std::vector<ExactPose> poses = {exact_pose(root)};
  for (const Joint& joint : robot.joints()) {
    Real position = 0;
    if (joint.variable >= 0) {
      position = Real(joint.multiplier) * configuration[static_cast<std::size_t>(joint.variable)] +
                 joint.offset;
    }
    poses.push_back(compose(compose(poses[static_cast<std::size_t>(joint.parent_link)],
                                    exact_pose(joint.parent_from_joint)),
                            exact_motion(joint, position)));
  }
  return poses;
}

double error_of(const Pose& computed, const ExactPose& pose, const Eigen::Vector3d& point) {
  const Vector<Real> p = exact<Real>(point);
  return sqrt(squared_distance(transform(computed, p), image(pose, p))).convert_to<double>();
}

TEST(Kinematics, ErrorBoundCoversTheErrorAndIsNotIdle) {
  Random random(2);
  double worst = 0.0;
  for (int i = 0; i < 90; ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 10), i % 2 == 0);
    const bool has_mimics = i % 3 == 0;
    if (has_mimics) add_random_mimics(random, robot, 5.0);
    const std::vector<double> configuration =
        random_configuration(random, robot, has_mimics ? 50.0 : 100.0);
    const Pose root = random.pose(10.0);
    const std::vector<Pose> poses = poses_of(robot, configuration, root);
    const std::vector<ExactPose> exact_poses = exact_poses_of(robot, configuration, root);
    const double reach = 1.5;
    const double bound = kinematics_error_bound(robot, reach, root.translation().norm() + 1e-9);
    for (std::size_t link = 1; link < poses.size(); ++link) {
      const Eigen::Vector3d point = reach * random.point(1.0).normalized() * (1.0 - 1e-12);
      const double error = error_of(poses[link], exact_poses[link], point);
      ASSERT_LE(error, bound);
      worst = std::max(worst, error / bound);
    }
  }
  EXPECT_GT(worst, 1e-3);
}

// A large offset that nearly cancels: the position's rounding is the whole error.
TEST(Kinematics, ErrorBoundCoversMimicsThatCancel) {
  Random random(6);
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    RobotModel robot;
    robot.add_link("a", "base_link", {.name = "a", .type = JointType::kPrismatic});
    robot.add_link("b", "base_link",
                   {.name = "b",
                    .type = i % 2 == 0 ? JointType::kContinuous : JointType::kPrismatic,
                    .lower = -1.0,
                    .upper = 1.0});
    const double plain = kinematics_error_bound(robot, 2.0);
    const double multiplier = random.between(1e5, 1e6);
    const double variable = random.between(90.0, 99.0);
    robot.mimic("b", "a", multiplier, random.between(-90.0, 90.0) - multiplier * variable);
    const std::vector<double> configuration = {variable};
    const double error = error_of(poses_of(robot, configuration)[2],
                                  exact_poses_of(robot, configuration, Pose())[2], {2.0, 0, 0});
    ASSERT_LE(error, kinematics_error_bound(robot, 2.0));
    worst = std::max(worst, error / plain);
  }
  EXPECT_GT(worst, 10.0) << "more than the bound without mimics";
}

TEST(Kinematics, PutsTheRootWhereItIsTold) {
  Random random(3);
  const RobotModel robot = random_robot(random, 3, false);
  const Pose root = random.pose(1.0);
  const Pose first = poses_of(robot, random_configuration(random, robot, 1.0), root)[0];
  EXPECT_EQ(first.matrix(), root.matrix());
  EXPECT_EQ(first.translation(), root.translation());
}

TEST(Kinematics, RefusesABadConfiguration) {
  Random random(4);
  RobotModel robot;
  robot.add_link("arm", "base_link", {.name = "hinge", .type = JointType::kRevolute});
  std::vector<Pose> poses;
  const auto run = [&](const std::vector<double>& q) { forward_kinematics(robot, q, poses); };
  EXPECT_NO_THROW(run({1.0}));
  EXPECT_THROW(run({}), Error);
  EXPECT_THROW(run({1.0, 2.0}), Error);
  EXPECT_THROW(run({std::nan("")}), Error);
  EXPECT_THROW(run({std::numeric_limits<double>::infinity()}), Error);
  robot.add_link("slide", "arm", {.name = "rail", .type = JointType::kPrismatic});
  EXPECT_NO_THROW(run({1.0, 1e15}));
  EXPECT_THROW(run({1.0, 1.1e15}), Error);
}

TEST(RobotCollides, IsTheCollisionOfAnyTreeOnAnyLink) {
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    RobotModel robot = random_robot(random, 5, true);
    std::vector<std::pair<std::size_t, std::shared_ptr<const SphereTree>>> trees;
    for (int k = 0; k < 4; ++k) {
      const auto link = static_cast<std::size_t>(random.whole(0, 5));
      trees.emplace_back(link, std::make_shared<const SphereTree>(
                                   build_tree(std::vector<Sphere>{{random.point(0.2), 0.3}})));
      robot.attach(robot.links()[link].name, trees.back().second);
    }
    const SphereTree obstacle = build_tree(std::vector<Sphere>{{random.point(1.0), 0.5}});
    const Pose world_from_obstacle = random.pose(1.0);
    const std::vector<Pose> poses = poses_of(robot, random_configuration(random, robot, 1.0));
    bool expected = false;
    for (const auto& [link, tree] : trees) {
      expected = expected || collides(*tree, poses[link], obstacle, world_from_obstacle);
    }
    ASSERT_EQ(robot_collides(robot, poses, obstacle, world_from_obstacle), expected);
    hits += expected;
  }
  EXPECT_GT(hits, 5);
  EXPECT_LT(hits, 55);
}

}  // namespace
}  // namespace spherule::test

// Angles less whole turns, against 100 digits of 2 pi.

namespace spherule::test::shortest_motion_test {
namespace {

using Real = boost::multiprecision::cpp_bin_float_100;

const Real kTurn = 2 * boost::math::constants::pi<Real>();

// How far `angle` is from `to` less the nearest number of whole turns.
double error_of(double angle, double to) {
  const Real turns = round((Real(to) - Real(angle)) / kTurn);
  return static_cast<double>(abs(Real(to) - turns * kTurn - Real(angle)));
}

TEST(NearestTurn, IsTheSamePostureAtMostHalfATurnAway) {
  Random random(71);
  double worst = 0.0;
  int turned = 0;
  for (int i = 0; i < effort(200000, 20000); ++i) {
    const double size = std::pow(10.0, random.between(-1.0, 2.0));
    const double from = random.between(-size, size);
    const double to = random.between(-size, size);
    const double angle = nearest_turn(from, to);
    worst = std::max(worst, error_of(angle, to));
    ASSERT_LE(std::abs(angle - from), std::numbers::pi + kTurnError);
    if (std::abs(to - from) <= std::numbers::pi) {
      ASSERT_EQ(angle, to);
    } else {
      ++turned;
      ASSERT_NE(angle, to);
    }
  }
  EXPECT_LE(worst, kTurnError);
  EXPECT_GT(worst, 0.4 * kTurnError);  // so that the bound is about this
  EXPECT_GT(turned, effort(50000, 5000));
}

TEST(NearestTurn, HalfATurnGoesAsGiven) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_EQ(nearest_turn(0.0, kPi), kPi);
  EXPECT_EQ(nearest_turn(0.0, -kPi), -kPi);
  EXPECT_LT(nearest_turn(0.0, std::nextafter(kPi, 4.0)), 0.0);
  EXPECT_GT(nearest_turn(0.0, std::nextafter(-kPi, -4.0)), 0.0);
  EXPECT_NEAR(nearest_turn(3.0, -3.0), 2.0 * kPi - 3.0, 1e-15);
  EXPECT_NEAR(nearest_turn(-99.0, 99.0), 99.0 - 64.0 * kPi, kTurnError);
}

// A continuous joint that slides along, and one that follows it as told.
RobotModel with_follower(JointType follower, double multiplier) {
  RobotModel robot("base");
  robot.add_link("slider", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -9.0, .upper = 9.0});
  robot.add_link("wheel", "slider", {.name = "lead", .type = JointType::kContinuous});
  robot.add_link("arm", "wheel", {.name = "follow", .type = follower, .lower = -3.0, .upper = 3.0});
  robot.mimic("follow", "lead", multiplier, 0.25);
  return robot;
}

TEST(ShortestMotion, OnlyContinuousJointsTurnOtherwise) {
  const RobotModel robot = with_follower(JointType::kContinuous, -2.0);
  const ShortestMotion motion(robot);
  EXPECT_NO_THROW(motion.require());
  EXPECT_FALSE(motion.turns(0));
  EXPECT_TRUE(motion.turns(1));
  const std::vector<double> from = {-4.0, 3.0};
  const std::vector<double> to = {4.0, -3.0};
  std::vector<double> end;
  EXPECT_EQ(motion.end_of(from, to, end)[0], 4.0);
  EXPECT_NEAR(motion.end_of(from, to, end)[1], 2.0 * std::numbers::pi - 3.0, 1e-15);
  EXPECT_THROW(motion.end_of(from, std::vector<double>{1.0}, end), Error);
  EXPECT_THROW(motion.end_of(std::vector<double>{1.0}, to, end), Error);
}

TEST(ShortestMotion, IsRefusedWhereAFollowerWouldEndElsewhere) {
  const auto refused = [](JointType follower, double multiplier) {
    try {
      ShortestMotion(with_follower(follower, multiplier)).require();
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), "joint follow");
      EXPECT_NE(error.reason().find("lead"), std::string::npos) << error.reason();
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused(JointType::kContinuous, 3.0));
  EXPECT_TRUE(refused(JointType::kContinuous, 0.5));
  EXPECT_TRUE(refused(JointType::kContinuous, 2.0 + 1e-15));
  EXPECT_TRUE(refused(JointType::kRevolute, 1.0));
  EXPECT_TRUE(refused(JointType::kPrismatic, 1.0));
  // Of a joint with limits no whole turns are taken off, whatever follows it.
  RobotModel robot("base");
  robot.add_link("a", "base",
                 {.name = "a", .type = JointType::kRevolute, .lower = -9.0, .upper = 9.0});
  robot.add_link("b", "a", {.name = "b", .type = JointType::kContinuous});
  robot.mimic("b", "a", 0.5);
  EXPECT_NO_THROW(ShortestMotion(robot).require());
  std::vector<double> end;
  EXPECT_EQ(ShortestMotion(robot).end_of(std::vector{3.0}, std::vector{-3.0}, end)[0], -3.0);
}

TEST(ShortestMotion, SaysSoWhereItsContentWasMoved) {
  ShortestMotion motion(with_follower(JointType::kContinuous, 1.0));
  const ShortestMotion other = std::move(motion);
  std::vector<double> end;
  // NOLINTNEXTLINE(bugprone-use-after-move)
  EXPECT_THROW(motion.end_of(std::vector{0.0, 3.0}, std::vector{0.0, -3.0}, end), Error);
  EXPECT_GT(other.end_of(std::vector{0.0, 3.0}, std::vector{0.0, -3.0}, end)[1], 3.0);
}

// What a turn is off is charged to the bound of the poses, multiplied as the joint turns by it.
TEST(ShortestMotion, RoundingOfTurnsIsCharged) {
  constexpr double kReach = 5.0;
  const auto error_with = [](double multiplier) {
    return internal::moving_pose_error(with_follower(JointType::kContinuous, multiplier), kReach,
                                       0.0, 0.0)
        .error;
  };
  EXPECT_GE(error_with(30.0) - error_with(30.5), 0.99 * 30.0 * kTurnError * kReach);
  EXPECT_GE(error_with(-3.0) - error_with(-2.0), 0.99 * kTurnError * kReach);
}

}  // namespace
}  // namespace spherule::test::shortest_motion_test
