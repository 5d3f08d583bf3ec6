// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/robot_model.h"

#include "base/error.h"
#include "spheretree/build.h"

#include <gtest/gtest.h>

#include <limits>

namespace spherule::test {
namespace {

Joint hinge(std::string name) {
  return {.name = std::move(name), .type = JointType::kRevolute};
}

TEST(RobotModel, NumbersLinksAndVariables) {
  RobotModel robot("base");
  EXPECT_EQ(robot.add_link("upper", "base", hinge("shoulder")), 1);
  EXPECT_EQ(robot.add_link("plate", "upper", {.name = "bolt"}), 2);
  EXPECT_EQ(robot.add_link("lower", "upper", hinge("elbow")), 3);
  EXPECT_EQ(robot.variable_count(), 2);
  EXPECT_EQ(robot.find_link("lower"), 3);
  EXPECT_EQ(robot.find_link("nothing"), -1);
  EXPECT_EQ(robot.links()[0].parent_joint, -1);
  EXPECT_EQ(robot.links()[3].parent_joint, 2);
  EXPECT_EQ(robot.joints()[1].variable, -1);
  EXPECT_EQ(robot.joints()[2].variable, 1);
  EXPECT_EQ(robot.joints()[2].parent_link, 1);
  EXPECT_EQ(robot.joints()[2].child_link, 3);
}

TEST(RobotModel, MakesTheAxisAndTheRotationUnit) {
  RobotModel robot("base");
  Joint joint = hinge("shoulder");
  joint.axis = {1e-200, 2e-200, -2e-200};
  joint.parent_from_joint = Pose(Eigen::Quaterniond(1e200, 0.0, 1e200, 0.0), {1.0, 2.0, 3.0});
  robot.add_link("upper", "base", joint);
  const Joint& stored = robot.joints()[0];
  EXPECT_LT((stored.axis - Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0).norm(), 1e-15);
  EXPECT_NEAR(stored.parent_from_joint.rotation().norm(), 1.0, 1e-15);
  EXPECT_EQ(stored.parent_from_joint.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(RobotModel, RefusesWhatIsNoMechanism) {
  RobotModel robot("base");
  robot.add_link("upper", "base", hinge("shoulder"));
  EXPECT_THROW(robot.add_link("upper", "base", hinge("other")), Error);
  EXPECT_THROW(robot.add_link("base", "upper", hinge("other")), Error);
  EXPECT_THROW(robot.add_link("lower", "upper", hinge("shoulder")), Error);
  EXPECT_THROW(robot.add_link("lower", "nothing", hinge("elbow")), Error);
  Joint joint = hinge("elbow");
  joint.axis = Eigen::Vector3d::Zero();
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint.axis = {1.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint = hinge("elbow");
  joint.lower = 1.0;
  joint.upper = -1.0;
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  joint.lower = -std::numeric_limits<double>::infinity();
  joint.upper = 1.0;
  EXPECT_THROW(robot.add_link("lower", "upper", joint), Error);
  EXPECT_EQ(robot.links().size(), 2u);
  EXPECT_EQ(robot.variable_count(), 1);

  EXPECT_THROW(robot.attach("nothing", std::make_shared<const SphereTree>(
                                           build_tree(std::vector<Sphere>{Sphere{}}))),
               Error);
  EXPECT_THROW(robot.attach("upper", nullptr), Error);
}

}  // namespace
}  // namespace spherule::test
