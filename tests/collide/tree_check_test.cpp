// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/tree_check.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/kernels/coherence_cache.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/pair_cache.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/rounding_mode.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::PlanSource;
using internal::TreeCheck;
using internal::TreeContact;

std::shared_ptr<const internal::SearchTrees> search_trees(const Vector3d& center, double radius) {
  return std::make_shared<const internal::SearchTrees>(std::vector<Sphere>{{center, radius}});
}

// A sphere on the last of the frames against one that stands still.
PlanSource one_test(std::vector<PlanSource::Frame> frames, const Sphere& body,
                    const Sphere& obstacle, const Pose& frame_from_body = Pose()) {
  PlanSource source;
  source.frames = std::move(frames);
  source.bodies = {{static_cast<int>(source.frames.size()) - 1,
                    search_trees(body.center, body.radius), frame_from_body}};
  source.obstacles = {{search_trees(obstacle.center, obstacle.radius), Pose()}};
  source.tests = {{.body = 0, .other = 0, .is_obstacle = true}};
  return source;
}

// An arm of length one about the z axis.
const std::vector<PlanSource::Frame> kArm(1);

// Whether single precision finds a sphere at the end of the arm apart from one that stands at a
// distance of `gap` from where it is at the angle, surely in contact, or is uncertain.
enum class Finding { kApart, kTouch, kUncertain };
Finding find(double angle, double gap, InstructionSet set) {
  const double way = 1.0 + 0.2 + gap;
  const Sphere obstacle{{way * std::cos(angle), way * std::sin(angle), 0.0}, 0.1};
  const TreeCheck check(one_test(kArm, {{1, 0, 0}, 0.1}, obstacle), 0, set);
  TreeCheck::Scratch scratch(check);
  bool queried = false;
  const auto confirm = [&](const TreeContact& contact) {
    EXPECT_EQ(contact.test, 0);
    EXPECT_EQ(contact.body_sphere, 0);
    queried = true;
    return false;
  };
  const bool hit = check.collides(std::array{angle}, scratch, confirm);
  return queried ? Finding::kUncertain : hit ? Finding::kTouch : Finding::kApart;
}

// The margins are thin: micrometres for an arm of a metre, at every angle that is in range.
TEST(TreeCheck, AsksOnlyWhereSinglePrecisionCannotTell) {
  Random random(31);
  std::vector<double> angles = {0.0, 100.0, -100.0};
  for (int i = -63; i <= 63; ++i) angles.push_back(i * 0.78539816339744831);
  for (int i = 0; i < 300; ++i) angles.push_back(random.between(-100.0, 100.0));
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
TEST(TreeCheck, OffsetsThatCancelAreMindedInTheMargins) {
  Random random(32);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d far = std::pow(10.0, random.between(8.0, 12.0)) * random.point(1.0);
    const Pose pose(Eigen::Quaterniond(random.quaternion()).normalized(), Eigen::Vector3d::Zero());
    const Pose back(pose.rotation(), -(pose * far));
    const Eigen::Vector3d direction = random.point(1.0).normalized();
    const double gap = random.between(-1e-3, 1e-3);
    const TreeCheck check(one_test(kArm, {far, 0.1}, {(0.2 + gap) * direction, 0.1}, back), 0);
    TreeCheck::Scratch scratch(check);
    bool queried = false;
    const auto confirm = [&](const TreeContact&) {
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
TEST(TreeCheck, ABlockNeverFindsApartWhatTouches) {
  Random random(33);
  for (int i = 0; i < 50; ++i) {
    std::vector<PlanSource::Frame> frames;
    std::array<double, 1000> variables;
    Pose pose;
    for (int k = 0; k < 1000; ++k) {
      frames.push_back({.parent = k - 1, .parent_from_frame = random.pose(0.0), .position = k});
      variables[static_cast<std::size_t>(k)] = random.between(-3.2, 3.2);
      const Eigen::AngleAxisd turn(variables[static_cast<std::size_t>(k)],
                                   Eigen::Vector3d::UnitZ());
      pose = pose * frames.back().parent_from_frame *
             Pose(Eigen::Quaterniond(turn), Eigen::Vector3d::Zero());
    }
    const Eigen::Vector3d away = (0.2 - 1e-9) * random.point(1.0).normalized();
    const PlanSource source =
        one_test(frames, {{0.3, 0, 0}, 0.1}, {pose * Eigen::Vector3d(0.3, 0, 0) + away, 0.1});
    for (const InstructionSet set : instruction_sets()) {
      const TreeCheck check(source, 0, set);
      TreeCheck::Scratch scratch(check);
      std::array<const double*, TreeCheck::kBlock> block;
      block.fill(variables.data());
      std::uint32_t queried = 0;
      const auto confirm = [&](int index, const TreeContact&) {
        queried |= 1U << index;
        return false;
      };
      const internal::KernelBlockAnswer answer = check.collides(block, scratch, confirm);
      EXPECT_EQ(answer.hits | queried, 0xffffU) << i;
      EXPECT_EQ(answer.refused, 0U);
    }
  }
}

TEST(TreeCheck, RefusesWhatReachesTooFar) {
  const Pose far = Pose::from_translation({9e14, 0, 0});
  const std::vector<PlanSource::Frame> frames = {
      {-1, far}, {.parent = 0, .parent_from_frame = far}, {.parent = 1, .parent_from_frame = far}};
  EXPECT_THROW(TreeCheck(one_test(frames, {{1, 0, 0}, 0.1}, {{2, 0, 0}, 0.1}), 0), Error);
}

// How far points of a sphere move, against where they are.

using internal::KernelFrame;
using internal::KernelPose;
using internal::MovedSphere;

// A chain or a tree of frames; two may share a variable.
std::vector<KernelFrame> random_frames(Random& random, int count) {
  std::vector<KernelFrame> frames;
  for (int i = 0; i < count; ++i) {
    KernelFrame frame = {};
    const Eigen::Matrix3d rotation = random.quaternion().normalized().toRotationMatrix();
    const Vector3d origin = random.point(random.whole(0, 2) == 0 ? 0.0 : 1.0);
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) frame.rotation[j][k] = rotation(k, j);
      frame.origin[j] = origin[j];
    }
    frame.parent = random.whole(0, 3) == 0 ? random.whole(-1, i - 1) : i - 1;
    frame.variable = random.whole(0, 9) == 0 ? 0 : i;
    frame.prismatic = random.whole(0, 3) == 0;
    frames.push_back(frame);
  }
  return frames;
}

std::vector<KernelPose> placed(const std::vector<KernelFrame>& frames,
                               const std::vector<double>& at) {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<KernelPose> result;
  for (const KernelFrame& frame : frames) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) pose.linear()(k, j) = frame.rotation[j][k];
      pose.translation()[j] = frame.origin[j];
    }
    const double variable = at[static_cast<std::size_t>(frame.variable)];
    if (frame.prismatic) {
      pose.translate(Vector3d(0, 0, variable));
    } else {
      pose.rotate(Eigen::AngleAxisd(variable, Vector3d::UnitZ()));
    }
    if (frame.parent >= 0) pose = poses[static_cast<std::size_t>(frame.parent)] * pose;
    poses.push_back(pose);
    KernelPose& columns = result.emplace_back();
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) columns.columns[j][k] = pose.matrix()(k, j);
    }
  }
  return result;
}

Vector3d image(const KernelPose& pose, const Vector3d& p) {
  Vector3d result;
  for (int k = 0; k < 3; ++k) {
    result[k] = pose.columns[0][k] * p.x() + pose.columns[1][k] * p.y() +
                pose.columns[2][k] * p.z() + pose.columns[3][k];
  }
  return result;
}

// Of the frames: how many of them share a variable at most.
double most_uses(const std::vector<KernelFrame>& frames) {
  std::vector<int> uses(frames.size(), 0);
  for (const KernelFrame& frame : frames) ++uses[static_cast<std::size_t>(frame.variable)];
  return *std::max_element(uses.begin(), uses.end());
}

// Of the sphere's points from the joints that carry it, and at least one.
double reach(const std::vector<KernelFrame>& frames, const std::vector<KernelPose>& poses,
             int frame, const Vector3d& center, double radius) {
  const Vector3d c = image(poses[static_cast<std::size_t>(frame)], center);
  double result = 1.0;
  for (int f = frame; f >= 0; f = frames[static_cast<std::size_t>(f)].parent) {
    const Vector3d origin = image(poses[static_cast<std::size_t>(f)], Vector3d::Zero());
    result = std::max(result, (c - origin).norm() + radius);
  }
  return result;
}

// To first order the sphere's centre goes by v and all is turned by w: said is |v| + |w| radius,
// and some point goes by the root of the sum of their squares, of which 60 points miss little. The
// rest is in the squares of the changes, for what is said and for what is true.
TEST(MovedSphere, NoPointGoesFurtherThanIsSaid) {
  Random random(71);
  int known = 0, tight = 0, curved = 0;
  for (int i = 0; i < 4000; ++i) {
    const int count = random.whole(1, 7);
    const std::vector<KernelFrame> frames = random_frames(random, count);
    std::vector<double> from(static_cast<std::size_t>(count)), to(from);
    const double size = std::pow(10.0, random.between(-9.0, 0.3));
    for (std::size_t k = 0; k < from.size(); ++k) {
      from[k] = random.between(-3.0, 3.0);
      to[k] = from[k] + (random.whole(0, 2) == 0 ? 0.0 : size * random.between(-1.0, 1.0));
    }
    const std::vector<KernelPose> before = placed(frames, from), after = placed(frames, to);
    const int frame = random.whole(0, count - 1);
    const Vector3d center = random.point(1.0);
    const double radius = random.whole(0, 4) == 0 ? 0.0 : random.between(0.0, 1.0);
    MovedSphere sphere(frames.data(), frames.size(), 1e-11);
    EXPECT_EQ(sphere.way_to(from.data()), std::numeric_limits<double>::infinity());
    sphere.place(frame, center.data(), radius, before.data(), from.data());
    const double said = sphere.way_to(to.data());
    if (std::isinf(said)) {
      EXPECT_GT(size, 0.01);
      continue;
    }
    const auto f = static_cast<std::size_t>(frame);
    double farthest = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Vector3d p = center + radius * random.point(1.0).normalized();
      farthest = std::max(farthest, (image(after[f], p) - image(before[f], p)).norm());
    }
    ASSERT_LE(farthest, said + 1e-14) << i;
    double changes = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) changes += std::abs(to[k] - from[k]);
    // A variable that moves several frames counts for each.
    changes *= most_uses(frames);
    const double bent = changes * changes * reach(frames, before, frame, center, radius);
    ASSERT_LE(said, 1.5 * farthest + 4.0 * bent + 2e-11 * changes + 1e-14) << i;
    ++known;
    tight += farthest > 0.9 * said;
    curved += size > 0.05;
  }
  EXPECT_GT(known, 2500);
  EXPECT_GT(tight, 800);
  EXPECT_GT(curved, 100);
}

TEST(MovedSphere, CountsTheCurvatureOfTheWay) {
  // Two hinges with parallel axes, one metre between them and another to the tip.
  KernelFrame hinge = {};
  for (int k = 0; k < 3; ++k) hinge.rotation[k][k] = 1.0;
  hinge.parent = -1;
  KernelFrame second = hinge;
  second.parent = 0;
  second.variable = 1;
  second.origin[0] = 1.0;
  const std::vector<KernelFrame> frames = {hinge, second};
  const std::vector<double> from = {0.0, 0.0};
  const Vector3d tip(1.0, 0.0, 0.0);
  MovedSphere sphere(frames.data(), 2, 0.0);
  const std::vector<KernelPose> before = placed(frames, from);
  sphere.place(1, tip.data(), 0.0, before.data(), from.data());
  // First order: the tip moves by 2 a - 2 a = 0.
  const std::vector<double> to = {0.05, -0.1};
  const std::vector<KernelPose> after = placed(frames, to);
  const double moved = (image(after[1], tip) - image(before[1], tip)).norm();
  const double said = sphere.way_to(to.data());
  EXPECT_GT(moved, 0.002);
  EXPECT_LE(moved, said);
  // Terms of second order alone, their lengths a quarter of the reach too large.
  EXPECT_LT(said, 0.02);
}

// What a check of a mechanism remembers from one configuration to the next: it saves questions and
// searches, and changes no answer.

constexpr double kNothing = -1.0;  // for a depth: nothing is to be remembered

// An arm of length one about the z axis whose tip is within a large sphere. `confirm` always says
// yes, and what is to be remembered with it.
class DeepContact {
 public:
  bool is_asked(double angle, double depth) {
    int queried = 0;
    const auto confirm = [&](const TreeContact&) {
      ++queried;
      if (depth > 0.0) check_.remember_contact(0, {{1, 0, 0}, 0.1}, depth, scratch_);
      return true;
    };
    EXPECT_TRUE(check_.collides(std::array{angle}, scratch_, confirm));
    EXPECT_FALSE(check_.is_following(scratch_));
    EXPECT_LE(queried, 1);
    return queried > 0;
  }

  // Rests at zero until a contact of that depth is known.
  void settle(double depth) {
    for (int i = 0; i < 5; ++i) is_asked(0.0, depth);
  }

  // How far the outermost point of the tip goes, to first order.
  static constexpr double kWayPerAngle = 1.1;

 private:
  static PlanSource source() {
    PlanSource source = one_test(kArm, {{1, 0, 0}, 0.1}, {{1, 0, 0}, 0.5});
    source.bodies[0].is_confirmed = true;
    return source;
  }

  TreeCheck check_{source(), 0};
  TreeCheck::Scratch scratch_{check_};
};

TEST(CoherenceCache, AContactHoldsAsFarAsItsDepth) {
  constexpr double kDepth = 1e-3;
  constexpr double kAngle = kDepth / DeepContact::kWayPerAngle;
  for (const double beyond : {1.01, -1.01}) {
    DeepContact contact;
    contact.settle(kDepth);
    for (const double part : {0.0, 0.5, -0.5, 0.99, -0.99, 0.1}) {
      EXPECT_FALSE(contact.is_asked(part * kAngle, kNothing)) << part;
    }
    EXPECT_TRUE(contact.is_asked(beyond * kAngle, kNothing));
  }
}

TEST(CoherenceCache, NothingIsKnownAfterAJump) {
  constexpr double kDepth = 1.0;
  DeepContact contact;
  // The first follows none, the second one that did not follow.
  EXPECT_TRUE(contact.is_asked(0.0, kDepth));
  EXPECT_TRUE(contact.is_asked(0.0, kDepth));
  contact.settle(kDepth);
  EXPECT_FALSE(contact.is_asked(0.01, kDepth));
  EXPECT_TRUE(contact.is_asked(0.16, kNothing));
  for (const double angle : {0.15, 0.14, 0.13}) {
    EXPECT_TRUE(contact.is_asked(angle, kNothing));
  }
  EXPECT_TRUE(contact.is_asked(0.12, kDepth));
  EXPECT_FALSE(contact.is_asked(0.11, kDepth));
}

// An arm of turns and shifts with a sphere on every frame. The true bodies are smaller spheres
// within the spheres, so that many contacts are refused.
struct Arm {
  std::vector<PlanSource::Frame> frames;
  std::vector<Sphere> spheres;
  std::vector<Sphere> obstacles;

  static constexpr double kTrueSize = 0.8;

  Vector3d center(std::size_t body, const std::vector<double>& at) const {
    Pose pose;
    for (std::size_t f = 0; f <= body; ++f) {
      pose = pose * frames[f].parent_from_frame;
      pose = pose * (frames[f].prismatic
                         ? Pose::from_translation({0.0, 0.0, at[f]})
                         : Pose(Eigen::Quaterniond(Eigen::AngleAxisd(at[f], Vector3d::UnitZ())),
                                Vector3d::Zero()));
    }
    return pose * spheres[body].center;
  }

  // By which the spheres of a test go into each other, of that size. All spheres are tested against
  // all obstacles.
  double depth(std::int32_t test, const std::vector<double>& at, double size) const {
    const auto body = static_cast<std::size_t>(test) % spheres.size();
    const Sphere& other = obstacles[static_cast<std::size_t>(test) / spheres.size()];
    return size * (spheres[body].radius + other.radius) - (center(body, at) - other.center).norm();
  }
  std::int32_t test_count() const {
    return static_cast<std::int32_t>(spheres.size() * obstacles.size());
  }

  // Confirmed: every pair is queried; otherwise pairs that are clearly apart are not.
  PlanSource source(bool is_confirmed) const {
    PlanSource source;
    source.frames = frames;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      source.bodies.push_back({static_cast<int>(i),
                               search_trees(spheres[i].center, spheres[i].radius), Pose(),
                               is_confirmed});
    }
    for (const Sphere& obstacle : obstacles) {
      source.obstacles.push_back({search_trees(obstacle.center, obstacle.radius), Pose()});
    }
    for (std::size_t i = 0; i < spheres.size() * obstacles.size(); ++i) {
      source.tests.push_back(
          {static_cast<int>(i % spheres.size()), static_cast<int>(i / spheres.size()), true});
    }
    return source;
  }
};

// A closed way of the variables, slow.
struct Way {
  explicit Way(Random& random, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      start.push_back(random.between(-2.0, 2.0));
      rate.push_back(random.between(0.001, 0.006));
    }
  }

  std::vector<double> at(int step) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < start.size(); ++i) {
      result.push_back(start[i] + 0.3 * std::sin(rate[i] * step));
    }
    return result;
  }

  std::vector<double> start;
  std::vector<double> rate;
};

// The obstacles stand where bodies come by, at distances within these shares of the radii's sum.
Arm random_arm(Random& random, const Way& way, int steps, double nearest, double farthest) {
  Arm arm;
  for (int f = 0; f < static_cast<int>(way.start.size()); ++f) {
    arm.frames.push_back({f - 1, random.pose(0.5), f, random.whole(0, 3) == 0});
    arm.spheres.push_back({random.point(0.3), random.between(0.05, 0.2)});
  }
  for (int i = 0; i < 6; ++i) {
    const auto body =
        static_cast<std::size_t>(random.whole(0, static_cast<int>(way.rate.size()) - 1));
    const Vector3d met = arm.center(body, way.at(random.whole(0, steps)));
    const double radius = random.between(0.05, 0.2);
    const double apart = random.between(nearest, farthest) * (arm.spheres[body].radius + radius);
    arm.obstacles.push_back({met + apart * random.point(1.0).normalized(), radius});
  }
  return arm;
}

TEST(CoherenceCache, SavesQuestionsAndChangesNoAnswer) {
  constexpr int kSteps = 1500;
  Random random(91);
  int touching = 0, refused = 0, unasked = 0, asked_anew = 0, queried = 0;
  for (int i = 0; i < 12; ++i) {
    const Way way(random, 4);
    const Arm arm = random_arm(random, way, kSteps, 0.7, 1.1);
    std::deque<TreeCheck> checks;
    checks.emplace_back(arm.source(false), 0, InstructionSet::kPortable);
    for (const InstructionSet set : instruction_sets())
      checks.emplace_back(arm.source(true), 0, set);
    for (std::size_t k = 0; k < checks.size(); ++k) {
      const TreeCheck& check = checks[k];
      TreeCheck::Scratch scratch(check);
      for (int step = 0; step < kSteps; ++step) {
        const std::vector<double> at = way.at(step);
        int questions = 0;
        const auto query = [&](TreeCheck::Scratch& remembering) {
          questions = 0;
          return check.collides(at, remembering, [&](const TreeContact& contact) {
            ++questions;
            const double depth = arm.depth(contact.test, at, Arm::kTrueSize);
            if (depth < 0.0) return false;
            const Sphere& sphere =
                arm.spheres[static_cast<std::size_t>(contact.test) % arm.spheres.size()];
            check.remember_contact(contact.test, {sphere.center, Arm::kTrueSize * sphere.radius},
                                   depth - 1e-12, remembering);
            return true;
          });
        };
        TreeCheck::Scratch anew(check);
        const bool truth = query(anew);
        const int all_questions = questions;
        ASSERT_EQ(query(scratch), truth) << i << " at step " << step;
        if (k == 0) continue;
        touching += truth;
        refused += !truth && all_questions > 0;
        if (!truth) continue;
        unasked += questions == 0;
        queried += questions;
        asked_anew += all_questions;
      }
    }
  }
  EXPECT_GT(touching, 2000);
  EXPECT_GT(refused, 1000);
  EXPECT_GT(unasked, touching * 4 / 5);
  EXPECT_LT(queried, asked_anew / 4);
}

// Bodies that touch an obstacle slightly on their way, or miss it by little.
TEST(CoherenceCache, OverlooksNoTouch) {
  constexpr int kSteps = 4000;
  Random random(92);
  int touching = 0, close = 0;
  for (int i = 0; i < effort(20, 5); ++i) {
    const Way way(random, 4);
    const Arm arm = random_arm(random, way, kSteps, 1.0 - 1e-3, 1.0 + 1e-2);
    std::deque<TreeCheck> checks;
    for (const InstructionSet set : instruction_sets())
      checks.emplace_back(arm.source(false), 0, set);
    std::deque<TreeCheck::Scratch> scratches;
    for (const TreeCheck& check : checks) scratches.emplace_back(check);
    const int stride = i % 2 == 0 ? 1 : 16;  // in steps that long the cache pauses
    for (int step = 0; step < kSteps; ++step) {
      const std::vector<double> at = way.at(step * stride);
      double depth = -1.0;
      for (std::int32_t test = 0; test < arm.test_count(); ++test) {
        depth = std::max(depth, arm.depth(test, at, 1.0));
      }
      for (std::size_t k = 0; k < checks.size(); ++k) {
        const bool hit = checks[k].collides(at, scratches[k], [&](const TreeContact& contact) {
          return arm.depth(contact.test, at, 1.0) >= 0.0;
        });
        ASSERT_EQ(hit, depth >= 0.0) << i << " at step " << step << ", " << depth;
      }
      touching += depth >= 0.0;
      close += std::abs(depth) < 1e-3;
    }
  }
  EXPECT_GT(touching, effort(500, 50));
  EXPECT_GT(close, effort(100, 10));
}

TEST(RoundingMode, OthersAreRefused) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
  const SphereTree tree = build_tree(spheres);
  const TriangleMesh cube = cube_mesh();
  expect_rounding_to_nearest_is_needed([] { require_rounding_to_nearest(); }, "test");
  expect_rounding_to_nearest_is_needed([&] { build_tree(spheres); }, "build_tree");
  expect_rounding_to_nearest_is_needed([&] { MeshTree{cube}; }, "MeshTree");
  expect_rounding_to_nearest_is_needed([&] { refit(tree, spheres); }, "refit");
  expect_rounding_to_nearest_is_needed([&] { check(tree); }, "check");
  expect_rounding_to_nearest_is_needed([&] { SphereTree{tree.data()}; }, "SphereTree");
  expect_rounding_to_nearest_is_needed([&] { PairCache(tree, tree); }, "PairCache");
}

}  // namespace
}  // namespace spherule::test
