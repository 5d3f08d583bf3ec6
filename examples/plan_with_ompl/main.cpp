// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <spherule/adapters/ompl/motion_validator.h>
#include <spherule/adapters/ompl/state_validity_checker.h>
#include <spherule/robot/check/robot_scene.h>
#include <spherule/spheretree/build.h>
#include <vector>

// A sphere on a rail, and a sphere in its way.
int main() {
  const auto sphere = std::make_shared<const spherule::SphereTree>(
      spherule::build_tree(std::vector<spherule::Sphere>{{{0.0, 0.0, 0.0}, 0.1}}));
  spherule::RobotModel robot;
  robot.add_link("sled", "base_link",
                 {.name = "rail",
                  .type = spherule::JointType::kPrismatic,
                  .axis = Eigen::Vector3d::UnitX(),
                  .lower = -1.0,
                  .upper = 1.0});
  robot.attach("sled", sphere);
  spherule::RobotScene scene(robot);
  scene.add("stop", sphere);
  const spherule::RobotChecker checker = scene.snapshot();

  auto space = std::make_shared<ompl::base::RealVectorStateSpace>(1);
  space->setBounds(-1.0, 1.0);
  const auto information = std::make_shared<ompl::base::SpaceInformation>(space);
  information->setStateValidityChecker(
      std::make_shared<spherule::StateValidityChecker>(information, checker));
  information->setMotionValidator(
      std::make_shared<spherule::MotionValidator>(information, checker));
  information->setup();
  ompl::base::ScopedState<> left(space), right(space);
  left = std::vector<double>{-0.5};
  right = std::vector<double>{0.5};
  const bool ends = information->isValid(left.get()) && information->isValid(right.get());
  return ends && !information->checkMotion(left.get(), right.get()) ? 0 : 1;
}
