// SPDX-License-Identifier: BSD-3-Clause
// A RobotChecker that is given proofs of pairs: links made of boxes under coarse spheres. What it
// says has to be what all canonical tests say, less the contacts of pairs that are proved free; and
// no boxes touch where it finds the robot free.

#include "base/error.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule::test::robot_proved_test {
namespace {

// Boxes cut across their longest side, a sphere around each piece.
std::vector<Sphere> coarse_cover(const std::vector<Eigen::AlignedBox3d>& boxes, int pieces) {
  std::vector<Sphere> spheres;
  for (const Eigen::AlignedBox3d& box : boxes) {
    int longest = 0;
    box.sizes().maxCoeff(&longest);
    for (int i = 0; i < pieces; ++i) {
      Eigen::AlignedBox3d piece = box;
      const double step = box.sizes()[longest] / pieces;
      piece.min()[longest] = box.min()[longest] + i * step;
      piece.max()[longest] = piece.min()[longest] + step;
      spheres.push_back({piece.center(), 0.5 * piece.diagonal().norm() * (1.0 + 1e-9)});
    }
  }
  return spheres;
}

std::shared_ptr<const SphereTree> tree_of(const std::vector<Sphere>& spheres) {
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

class ProvedRobot : public testing::Test {
 protected:
  inline static const LinkPairOptions kShort{
      .boxes = 300, .undecided_boxes = 300, .samples = 20, .threads = 1};

  void make(Random& random) {
    robot_ = random_box_robot(random, random.whole(2, 6), random.whole(0, 3) == 0,
                              random.whole(0, 3) == 0);
    pairs_ =
        std::make_shared<const LinkPairs>(prove_link_pairs(robot_.model, robot_.bodies, kShort));
    RobotModel model = robot_.model;
    for (std::size_t i = 0; i < robot_.boxes.size(); ++i) {
      if (robot_.boxes[i].empty()) continue;
      model.attach(model.links()[i].name, tree_of(coarse_cover(robot_.boxes[i], 3)));
    }
    scene_.emplace(model);
    if (random.whole(0, 1) == 0) scene_->add("ball", SolidSphere{0.2}, random.pose(2.0));
    attach_tool(random);
    plain_.emplace(*scene_);
    scene_->set_link_pairs(pairs_);
    if (tool_pairs_ != nullptr) scene_->set_attached_pairs("tool", tool_pairs_);
    checked_.clear();
    for (const InstructionSet set : instruction_sets()) {
      checked_.emplace_back(*scene_, RobotCheckerOptions{.instructions = set});
    }
  }

  void attach_tool(Random& random) {
    tool_pairs_ = nullptr;
    if (random.whole(0, 1) == 0) return;
    BoxRobot tool{robot_.model};
    tool_link_ = random.whole(0, static_cast<int>(robot_.model.links().size()) - 1);
    const Eigen::Vector3d corner = random.point(0.4);
    tool_boxes_ = {{corner, corner + Eigen::Vector3d(0.05, 0.1, 0.3)}};
    tool.add_boxes(tool_link_, tool_boxes_);
    tool_pairs_ = std::make_shared<const LinkPairs>(
        prove_attached_pairs(robot_.model, robot_.bodies, tool.bodies.front(), kShort));
    const std::string& name = robot_.model.links()[static_cast<std::size_t>(tool_link_)].name;
    // Its spheres are in a frame of its own, the proofs are in the link's.
    const Eigen::Vector3d origin = random.point(0.5);
    std::vector<Eigen::AlignedBox3d> in_tool = tool_boxes_;
    for (Eigen::AlignedBox3d& box : in_tool) box.translate(-origin);
    scene_->attach("tool", name, tree_of(coarse_cover(in_tool, 2)), Pose::from_translation(origin));
  }

  bool is_proved(const CheckedContact& contact, const Configuration& q) const {
    const bool is_tool = contact.first.name == "tool" || contact.second.name == "tool";
    if (is_tool && tool_pairs_ == nullptr) return false;
    const auto link = [&](const CheckedBody& body) {
      return body.name == "tool" ? tool_link_ : robot_.model.find_link(body.name);
    };
    const int first = link(contact.first);
    const int second = link(contact.second);
    if (first < 0 || second < 0) return false;  // an obstacle
    return (is_tool ? *tool_pairs_ : *pairs_).is_free(first, second, q);
  }

  // By all canonical tests and the proofs.
  bool touches(const Configuration& q) {
    const std::vector<CheckedContact> contacts = plain_->explain(q);
    return !std::all_of(contacts.begin(), contacts.end(),
                        [&](const CheckedContact& contact) { return is_proved(contact, q); });
  }

  // Some are beyond the limits.
  Configuration random_posture(Random& random) const {
    const double wider = random.whole(0, 4) == 0 ? 1.5 : 1.0;
    Configuration result = random_in_ranges(random, robot_.model);
    for (double& value : result) value *= wider;
    return result;
  }

  void expect_solids_free(const Configuration& q) {
    forward_kinematics(robot_.model, q, poses_);
    const AllowedCollisions& allowed = scene_->allowed_collisions();
    for (const LinkPair& pair : pairs_->pairs()) {
      if (allowed.allows(pair.first, pair.second)) continue;
      ASSERT_FALSE(boxes_touch(robot_, pair.first, pair.second, poses_, 1e-9));
    }
    if (tool_pairs_ == nullptr) return;
    BoxRobot with_tool{robot_.model, robot_.boxes};
    const std::size_t tool = robot_.model.links().size();
    with_tool.boxes.resize(tool);
    with_tool.boxes.push_back(tool_boxes_);
    poses_.push_back(poses_[static_cast<std::size_t>(tool_link_)]);
    for (const LinkPair& pair : tool_pairs_->pairs()) {
      const int other = pair.first == tool_link_ ? pair.second : pair.first;
      ASSERT_FALSE(boxes_touch(with_tool, other, static_cast<int>(tool), poses_, 1e-9));
    }
  }

  BoxRobot robot_{RobotModel("none")};
  std::shared_ptr<const LinkPairs> pairs_;
  std::shared_ptr<const LinkPairs> tool_pairs_;
  int tool_link_ = -1;
  std::vector<Eigen::AlignedBox3d> tool_boxes_;
  std::optional<RobotScene> scene_;
  std::optional<Checked> plain_;
  std::deque<Checked> checked_;
  std::vector<Pose> poses_;
};

TEST_F(ProvedRobot, ConfigurationsAreFreeByProofsOrSpheres) {
  Random random(seeded(5101));
  int free = 0;
  int freed = 0;
  for (int n = 0; n < scaled(60, 10); ++n) {
    make(random);
    std::vector<double> all;
    std::vector<std::uint8_t> truth;
    const int count = random.whole(1, 60);
    for (int i = 0; i < count; ++i) {
      const Configuration q = random_posture(random);
      const bool is_free = !touches(q);
      free += is_free ? 1 : 0;
      freed += is_free && !plain_->free(q) ? 1 : 0;
      if (is_free) expect_solids_free(q);
      all.insert(all.end(), q.begin(), q.end());
      truth.push_back(is_free ? 1 : 0);
      for (Checked& checked : checked_) ASSERT_EQ(checked.free(q), is_free) << n;
      EXPECT_EQ(checked_.front().explain(q).empty(), is_free);
    }
    for (Checked& checked : checked_) ASSERT_EQ(checked.free(all, truth.size()), truth) << n;
  }
  EXPECT_GT(freed, free / 60);
}

TEST_F(ProvedRobot, MotionsAreFreeByProofsOrSpheres) {
  Random random(seeded(5102));
  int free = 0;
  int freed = 0;
  int unknown = 0;
  for (int n = 0; n < scaled(60, 10); ++n) {
    make(random);
    for (int i = 0; i < 20; ++i) {
      const Configuration from = random_posture(random);
      const Configuration to =
          on_the_way(from, random_posture(random), std::pow(10.0, random.between(-2.0, 0.0)));
      const EdgeRequest request{.resolution = 1e-4, .first = random.whole(0, 1) == 0};
      for (Checked& checked : checked_) {
        const EdgeResult result = checked.edge(from, to, request);
        expect_so([&](const Configuration& q) { return touches(q); }, from, to, result,
                  effort(100, 20));
        if (HasFatalFailure()) return;
        unknown += result.verdict == Verdict::kUnknown ? 1 : 0;
        if (result.verdict != Verdict::kFree) continue;
        ++free;
        freed += plain_->edge(from, to).verdict != Verdict::kFree ? 1 : 0;
        for (int step = 0; step <= 20; ++step)
          expect_solids_free(on_the_way(from, to, step / 20.0));
      }
    }
  }
  EXPECT_GT(freed, free / 60);
  EXPECT_LT(unknown, free / 20);
}

// Two bars on one axis, the outer ends of which meet where the joint stands at zero.
class TwoBarScene : public testing::Test {
 protected:
  TwoBarScene() {
    for (const int link : {1, 2}) {
      const auto index = static_cast<std::size_t>(link);
      robot_.model.attach(robot_.model.links()[index].name,
                          tree_of(coarse_cover(robot_.boxes[index], 4)));
    }
    pairs_ = std::make_shared<const LinkPairs>(prove_link_pairs(robot_.model, robot_.bodies));
  }

  BoxRobot robot_ = two_turning_bars(0.0);
  std::shared_ptr<const LinkPairs> pairs_;
};

TEST_F(TwoBarScene, ReasonsAndExplanationsTellOfProofs) {
  RobotScene scene(robot_.model);
  EXPECT_EQ(scene.reason("first", "second"), AllowedReason::kTested);
  scene.set_link_pairs(pairs_);
  EXPECT_EQ(scene.reason("first", "second"), AllowedReason::kProvedNever);
  Checked checked(scene);
  const Configuration aligned{0.0, 0.0};
  EXPECT_TRUE(checked.free(aligned));
  EXPECT_TRUE(checked.explain(aligned).empty());
  const auto told = checked.explain(aligned, {.proved_free = true});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(told.front().is_proved_free);
  EXPECT_GT(told.front().overlap_depth, 0.0);
  // Beyond the limits nothing is proved.
  EXPECT_FALSE(checked.free(Configuration{1.5, 1.5}));
  EXPECT_FALSE(checked.explain(Configuration{1.5, 1.5}).front().is_proved_free);
}

TEST_F(TwoBarScene, PaddingTakesProofsAway) {
  RobotScene scene(robot_.model);
  scene.set_link_pairs(pairs_);
  const auto expect = [&](AllowedReason reason) {
    EXPECT_EQ(scene.reason("second", "first"), reason);
    const bool is_free = Checked(scene).free(Configuration{0.0, 0.0});
    EXPECT_EQ(is_free, reason == AllowedReason::kProvedNever);
  };
  expect(AllowedReason::kProvedNever);
  scene.set_padding("first", "second", 0.02);
  expect(AllowedReason::kTested);
  scene.set_padding("first", "second", 0.0);
  expect(AllowedReason::kProvedNever);
  scene.set_padding("first", 0.02);
  expect(AllowedReason::kTested);
}

TEST_F(TwoBarScene, ProofsOfAnotherRobotAreRefused) {
  RobotModel other = robot_.model;
  other.add_link("third", "second", {.name = "fixed"});
  RobotScene scene(other);
  EXPECT_THROW(scene.set_link_pairs(pairs_), Error);
  EXPECT_THROW(scene.set_attached_pairs("tool", nullptr), Error);
  RobotScene own(robot_.model);
  own.set_link_pairs(pairs_);
  own.set_link_pairs(nullptr);
  EXPECT_EQ(own.reason("first", "second"), AllowedReason::kTested);
  EXPECT_THROW(own.reason("first", "nobody"), Error);
}

TEST_F(TwoBarScene, ProofsOfToolsAreForTheirLinkAlone) {
  const auto of_tool = std::make_shared<const LinkPairs>(prove_attached_pairs(
      robot_.model, robot_.bodies, {.link = 2, .mesh = robot_.bodies[1].mesh}));
  RobotScene scene(robot_.model);
  const auto& tree = robot_.model.links()[2].trees.front();
  scene.attach("tool", "second", tree);
  scene.attach("other", "first", tree);
  scene.set_attached_pairs("tool", of_tool);
  EXPECT_THROW(scene.set_link_pairs(of_tool), Error);
  EXPECT_THROW(scene.set_attached_pairs("other", of_tool), Error);
  EXPECT_THROW(scene.set_attached_pairs("tool", pairs_), Error);
}

// The two ends of a locked joint's range differ by rounding: 0.3, and 0.1 + 0.2.
TEST(ProvedScene, RangesAsThinAsRoundingAreNoFreeCells) {
  BoxRobot robot{RobotModel("base")};
  robot.model.add_link("lock", "base", turning(0.3, 0.1 + 0.2));
  robot.model.add_link("bar", "lock", turning(-2.0, 2.0));
  robot.add_boxes(0, {{Eigen::Vector3d(0.9, -0.1, -0.1), Eigen::Vector3d(1.1, 0.1, 0.1)}});
  robot.add_boxes(1, {{Eigen::Vector3d(0.0, 0.0, 3.0), Eigen::Vector3d(0.1, 0.1, 3.1)}});
  robot.add_boxes(2, {{Eigen::Vector3d(0.0, -0.02, -0.05), Eigen::Vector3d(2.0, 0.02, 0.05)}});
  const auto pairs = std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, robot.bodies));
  for (std::size_t i = 0; i < 3; ++i) {
    robot.model.attach(robot.model.links()[i].name, tree_of(coarse_cover(robot.boxes[i], 6)));
  }
  RobotScene scene(robot.model);
  scene.set_link_pairs(pairs);
  Checked checked(scene);
  std::vector<Pose> poses;
  int touching = 0;
  for (int i = -200; i <= 200; ++i) {
    const Configuration q{0.3, 0.01 * i};
    forward_kinematics(robot.model, q, poses);
    if (!boxes_touch(robot, 0, 2, poses, 1e-6)) continue;
    ++touching;
    EXPECT_FALSE(checked.free(q)) << q[1];
  }
  EXPECT_GT(touching, 10);
}

TEST_F(TwoBarScene, ContactsAreToldBeforeWhatIsProvedFree) {
  RobotScene scene(robot_.model);
  scene.set_link_pairs(pairs_);
  scene.add("wall", SolidSphere{0.1}, Pose::from_translation({0.5, 0.0, 0.0}));
  Checked checked(scene);
  const Configuration aligned{0.0, 0.0};
  for (std::size_t most = 1; most <= 3; ++most) {
    const auto told = checked.explain(aligned, {.max_contacts = most, .proved_free = true});
    ASSERT_EQ(told.size(), most);
    for (std::size_t i = 0; i < most; ++i) EXPECT_EQ(told[i].is_proved_free, i == 2);
  }
}

}  // namespace
}  // namespace spherule::test::robot_proved_test
