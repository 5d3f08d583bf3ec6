// SPDX-License-Identifier: BSD-3-Clause
// The kinematics of robots that were read from files, against KDL.

#include "robot/files/urdf.h"
#include "robot/model/kinematics.h"
#include "tests/robot/files/kdl_robot.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace spherule::test {
namespace {

std::string name_of_variable(const RobotModel& robot, int variable) {
  const int joint = robot.variable_joints()[static_cast<std::size_t>(variable)];
  return robot.joints()[static_cast<std::size_t>(joint)].name;
}

void compare_with_kdl(const std::filesystem::path& urdf, Random& random, int configurations) {
  const RobotDescription robot = read_urdf(urdf);
  const KdlRobot kdl(urdf);
  ASSERT_EQ(robot.model.links().size(), kdl.links().size());
  ASSERT_EQ(static_cast<std::size_t>(robot.model.variable_count()), kdl.variables().size());
  for (int i = 0; i < configurations; ++i) {
    std::vector<double> configuration;
    std::map<std::string, double> by_name;
    for (int k = 0; k < robot.model.variable_count(); ++k) {
      configuration.push_back(i == 0 ? 0.0 : random.between(-3.0, 3.0));
      by_name[name_of_variable(robot.model, k)] = configuration.back();
    }
    std::vector<Pose> poses;
    forward_kinematics(robot.model, configuration, poses);
    const auto expected = kdl.poses(by_name);
    for (std::size_t link = 0; link < poses.size(); ++link) {
      const Eigen::Isometry3d& pose = expected.at(robot.model.links()[link].name);
      const double size = 1.0 + pose.translation().norm();
      ASSERT_LE((poses[link].matrix() - pose.linear()).cwiseAbs().maxCoeff(), 1e-11);
      ASSERT_LE((poses[link].translation() - pose.translation()).norm(), 1e-11 * size)
          << robot.model.links()[link].name;
    }
  }
}

TEST(UrdfKinematics, AgreesWithKdlOnRandomRobots) {
  Random random(61);
  const TempDir folder;
  for (int i = 0; i < effort(200, 20); ++i) {
    const std::string urdf = random_urdf(random, static_cast<int>(random.index(15)));
    SCOPED_TRACE(urdf);
    compare_with_kdl(folder.write("robot_" + std::to_string(i) + ".urdf", urdf), random, 5);
    if (HasFatalFailure()) return;
  }
}

TEST(UrdfKinematics, AgreesWithKdlOnRealRobots) {
  const auto models = models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS names no folder";
  Random random(62);
  std::set<std::string> read;
  for (const auto& robot : std::filesystem::directory_iterator(*models / "robots")) {
    for (const auto& file : std::filesystem::directory_iterator(robot)) {
      if (file.path().extension() != ".urdf") continue;
      SCOPED_TRACE(file.path());
      compare_with_kdl(file.path(), random, 50);
      read.insert(file.path().stem());
    }
  }
  for (const char* name : {"irb4400l_30_243", "fr3_collision", "franka_panda", "panda_collision"}) {
    EXPECT_TRUE(read.contains(name)) << name;
  }
}

}  // namespace
}  // namespace spherule::test
