// SPDX-License-Identifier: BSD-3-Clause
// Clearances that pass over what is proved free.
#include "robot/check/robot_scene.h"
#include "spheretree/build.h"
#include "tests/robot/box_robots.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace spherule::test {
namespace {

using Configuration = std::vector<double>;

// Two thin bars one above the other, each in a sphere, that turn about one axis: the spheres
// overlap in all configurations, the bars touch in none. A post stands away from both.
class ClearanceScene : public testing::Test {
 protected:
  ClearanceScene() {
    for (const int link : {1, 2}) {
      const double height = 0.03 * link;
      robot_.model.attach(robot_.model.links()[static_cast<std::size_t>(link)].name,
                          std::make_shared<const SphereTree>(build_tree(
                              std::vector<Sphere>{{{0.4, 0.0, height + 0.01}, kRadius}})));
    }
    scene_.emplace(robot_.model);
    scene_->add("post", SolidSphere{0.1}, Pose::from_translation({1.5, 0.0, 0.04}));
  }

  RobotClearance clearance(const Configuration& configuration, const ClearanceRequest& request) {
    const RobotChecker checker = scene_->snapshot();
    RobotChecker::Scratch scratch(checker);
    return checker.clearance(configuration, scratch, request);
  }

  static constexpr double kRadius = 0.21;
  BoxRobot robot_ = two_turning_bars(0.03);
  std::optional<RobotScene> scene_;
};

TEST_F(ClearanceScene, SkipsWhatIsProvedFreeOnRequest) {
  const ClearanceRequest skipping{.skip_proved_free = true};
  const Configuration aligned{0.0, 0.0};
  EXPECT_EQ(clearance(aligned, skipping).lower, 0.0) << "nothing is proved";
  EXPECT_FALSE(clearance(aligned, skipping).skipped);

  scene_->set_link_pairs(
      std::make_shared<const LinkPairs>(prove_link_pairs(robot_.model, robot_.bodies)));
  EXPECT_EQ(clearance(aligned, {}).lower, 0.0);
  EXPECT_FALSE(clearance(aligned, {}).skipped);
  // The post is 1.1 m from either centre.
  const RobotClearance rest = clearance(aligned, skipping);
  EXPECT_TRUE(rest.skipped);
  EXPECT_EQ(rest.second.name, "post");
  EXPECT_LE(rest.lower, 1.1 - 0.1 - kRadius);
  EXPECT_NEAR(rest.lower, 1.1 - 0.1 - kRadius, 1e-9);
  // Beyond the limits nothing is proved.
  EXPECT_EQ(clearance({1.5, 1.5}, skipping).lower, 0.0);
  EXPECT_FALSE(clearance({1.5, 1.5}, skipping).skipped);
  // Nothing else is left where the post is gone.
  scene_->remove("post");
  EXPECT_EQ(clearance(aligned, skipping).lower, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace spherule::test
