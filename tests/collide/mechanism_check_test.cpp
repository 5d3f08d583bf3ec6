// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/mechanism_check.h"

#include "base/error.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// An arm of length one about the z axis.
const std::vector<MechanismFrame> kArm(1);

// Whether single precision finds a sphere at the end of the arm apart from one that stands at a
// distance of `gap` from where it is at the angle, surely in contact, or is uncertain.
enum class Finding { kApart, kTouch, kUncertain };
Finding find(double angle, double gap, InstructionSet set) {
  const double way = 1.0 + 0.2 + gap;
  const std::vector<MechanismBody> bodies = {{0, Pose(), one_sphere_tree({1, 0, 0}, 0.1)}};
  const std::vector<MechanismObstacle> obstacles = {
      {Pose(), one_sphere_tree({way * std::cos(angle), way * std::sin(angle), 0.0}, 0.1)}};
  const std::vector<MechanismPair> pairs(1);
  const MechanismCheck check(kArm, bodies, obstacles, pairs, 0.0, {.instructions = set});
  MechanismCheck::Scratch scratch(check);
  bool queried = false;
  const auto confirm = [&](const MechanismContact& contact) {
    EXPECT_EQ(contact.pair.body, 0);
    EXPECT_EQ(contact.body_sphere, 0);
    queried = true;
    return false;
  };
  const bool hit = check.collides(std::array{angle}, scratch, confirm);
  return queried ? Finding::kUncertain : hit ? Finding::kTouch : Finding::kApart;
}

// The margins are thin: micrometres for an arm of a metre, at every angle that is in range.
TEST(MechanismCheck, AsksOnlyWhereSinglePrecisionCannotTell) {
  SceneRandom random(31);
  std::vector<double> angles = {0.0, 100.0, -100.0};
  for (int i = -63; i <= 63; ++i) angles.push_back(i * 0.78539816339744831);
  for (int i = 0; i < 300; ++i) angles.push_back(random.uniform(-100.0, 100.0));
  for (const InstructionSet set : instruction_sets()) {
    for (const double angle : angles) {
      SCOPED_TRACE(angle);
      EXPECT_EQ(find(angle, 1e-5, set), Finding::kApart);
      EXPECT_EQ(find(angle, -2e-5, set), Finding::kTouch);
      EXPECT_EQ(find(angle, 1e-9, set), Finding::kUncertain);
      EXPECT_EQ(find(angle, -1e-9, set), Finding::kUncertain);
    }
  }
}

// A tree far from its own frame that the pose leads back: moving its centres costs more than what
// is left of their offsets lets think.
TEST(MechanismCheck, OffsetsThatCancelAreMindedInTheMargins) {
  SceneRandom random(32);
  const std::vector<MechanismPair> pairs(1);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d far = std::pow(10.0, random.uniform(8.0, 12.0)) * random.point(1.0);
    const Pose pose(Eigen::Quaterniond(random.quaternion()).normalized(), Eigen::Vector3d::Zero());
    const Pose back(pose.rotation(), -(pose * far));
    const Eigen::Vector3d direction = random.point(1.0).normalized();
    const double gap = random.uniform(-1e-3, 1e-3);
    const std::vector<MechanismBody> bodies = {{0, back, one_sphere_tree(far, 0.1)}};
    const std::vector<MechanismObstacle> obstacles = {
        {Pose(), one_sphere_tree((0.2 + gap) * direction, 0.1)}};
    const MechanismCheck check(kArm, bodies, obstacles, pairs, 0.0);
    MechanismCheck::Scratch scratch(check);
    bool queried = false;
    const auto confirm = [&](const MechanismContact&) {
      queried = true;
      return false;
    };
    const bool hit = check.collides(std::array{0.0}, scratch, confirm);
    const PlacedSphereSets exactly{{far, 0.1}, {(0.2 + gap) * direction, 0.1}, back, Pose()};
    EXPECT_TRUE(queried || hit == exactly.overlap()) << i;
  }
}

// Poses are computed in single precision where configurations are checked side by side: over a long
// chain their error is many times what it is for one configuration.
TEST(MechanismCheck, ABlockNeverFindsApartWhatTouches) {
  SceneRandom random(33);
  for (int i = 0; i < 50; ++i) {
    std::vector<MechanismFrame> frames;
    std::array<double, 1000> variables;
    Pose pose;
    for (int k = 0; k < 1000; ++k) {
      frames.push_back({.parent = k - 1, .parent_from_frame = random.pose(0.0), .variable = k});
      variables[static_cast<std::size_t>(k)] = random.uniform(-3.2, 3.2);
      const Eigen::AngleAxisd turn(variables[static_cast<std::size_t>(k)],
                                   Eigen::Vector3d::UnitZ());
      pose = pose * frames.back().parent_from_frame *
             Pose(Eigen::Quaterniond(turn), Eigen::Vector3d::Zero());
    }
    const std::vector<MechanismBody> bodies = {{999, Pose(), one_sphere_tree({0.3, 0, 0}, 0.1)}};
    const Eigen::Vector3d away = (0.2 - 1e-9) * random.point(1.0).normalized();
    const std::vector<MechanismObstacle> obstacles = {
        {Pose(), one_sphere_tree(pose * Eigen::Vector3d(0.3, 0, 0) + away, 0.1)}};
    const std::vector<MechanismPair> pairs(1);
    for (const InstructionSet set : instruction_sets()) {
      const MechanismCheck check(frames, bodies, obstacles, pairs, 0.0, {.instructions = set});
      MechanismCheck::Scratch scratch(check);
      std::array<const double*, MechanismCheck::kBlock> block;
      block.fill(variables.data());
      std::uint32_t queried = 0;
      const auto confirm = [&](int index, const MechanismContact&) {
        queried |= 1U << index;
        return false;
      };
      const MechanismCheck::BlockAnswer answer = check.collides(block, scratch, confirm);
      EXPECT_EQ(answer.collides | queried, 0xffffU) << i;
      EXPECT_EQ(answer.out_of_range, 0U);
    }
  }
}

std::string refused(const std::vector<MechanismFrame>& frames,
                    const std::vector<MechanismBody>& bodies,
                    const std::vector<MechanismObstacle>& obstacles,
                    const std::vector<MechanismPair>& pairs, double pose_error = 0.0) {
  try {
    const MechanismCheck check(frames, bodies, obstacles, pairs, pose_error);
    return "accepted";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(MechanismCheck, RefusesBadInputByName) {
  const std::vector<MechanismBody> bodies = {{0, Pose(), one_sphere_tree({1, 0, 0}, 0.1)}};
  const std::vector<MechanismObstacle> obstacles = {{Pose(), one_sphere_tree({2, 0, 0}, 0.1)}};
  const std::vector<MechanismPair> pairs(1);
  EXPECT_EQ(refused(kArm, bodies, obstacles, pairs), "accepted");
  const auto says = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  std::vector<MechanismFrame> frames(2);
  frames[1].parent = 1;
  EXPECT_TRUE(says(refused(frames, bodies, obstacles, pairs), "frame 1"));
  frames[1] = {};
  for (const int bad : {-1, std::numeric_limits<int>::max()}) {
    frames[1].variable = bad;
    EXPECT_TRUE(says(refused(frames, bodies, obstacles, pairs), "frame 1"));
  }
  EXPECT_TRUE(says(refused(kArm, {{1, Pose(), bodies[0].tree}}, obstacles, pairs), "body 0"));
  EXPECT_TRUE(says(refused(kArm, {{0, Pose(), nullptr}}, obstacles, pairs), "body 0"));
  EXPECT_TRUE(says(refused(kArm, bodies, {{Pose(), nullptr}}, pairs), "obstacle 0"));
  EXPECT_TRUE(says(refused(kArm, bodies, obstacles, {{0, 1}}), "pair 0"));
  EXPECT_TRUE(says(refused(kArm, bodies, obstacles, {{-1, 0}}), "pair 0"));
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(says(refused(kArm, bodies, obstacles, pairs, bad), "pose error"));
  }
  frames.assign(3, {});
  for (MechanismFrame& frame : frames) {
    frame.parent_from_frame = Pose::from_translation({9e14, 0, 0});
  }
  frames[1].parent = 0;
  frames[2].parent = 1;
  EXPECT_TRUE(says(refused(frames, {{2, Pose(), bodies[0].tree}}, obstacles, pairs), "too far"));
}

TEST(MechanismCheck, RefusesTheScratchOfAnother) {
  const std::vector<MechanismBody> bodies = {{0, Pose(), one_sphere_tree({1, 0, 0}, 0.1)}};
  const std::vector<MechanismObstacle> obstacles = {{Pose(), one_sphere_tree({3, 0, 0}, 0.1)}};
  const std::vector<MechanismPair> pairs(1);
  const MechanismCheck other(kArm, bodies, obstacles, pairs, 0.0);
  MechanismCheck::Scratch scratch(other);
  const MechanismCheck check(kArm, bodies, obstacles, pairs, 0.0);
  const std::array<double, 1> q = {0.0};
  std::array<const double*, MechanismCheck::kBlock> block;
  block.fill(q.data());
  const auto none = [](const auto&...) { return false; };
  EXPECT_FALSE(other.collides(q, scratch, none));
  EXPECT_THROW((void)check.collides(q, scratch, none), Error);
  EXPECT_THROW((void)check.collides(block, scratch, none), Error);
  EXPECT_THROW((void)check.is_following(scratch), Error);
  EXPECT_THROW(check.remember_contact(0, {{1, 0, 0}, 0.1}, 0.1, scratch), Error);
}

}  // namespace
}  // namespace spherule::test
