// SPDX-License-Identifier: BSD-3-Clause
// What a check of a mechanism remembers from one configuration to the next: it saves questions and
// searches, and changes no answer.

#include "collide/mechanism/coherence_cache.h"

#include "collide/mechanism/mechanism_check.h"
#include "tests/collide/scene_random.h"
#include "tests/collide/trees.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::CoherenceCache;
using internal::KernelFinding;
using internal::KernelFrame;
using internal::KernelPair;
using internal::KernelPose;
using internal::KernelProblem;
using internal::Kernels;
using internal::KernelScratch;

const std::vector<MechanismPair> kOnePair(1);
constexpr double kNothing = -1.0;  // for a depth: nothing is to be remembered

// An arm of length one about the z axis whose tip is within a large sphere. `confirm` always says
// yes, and what is to be remembered with it.
class DeepContact {
 public:
  bool is_asked(double angle, double depth) {
    int queried = 0;
    const auto confirm = [&](const MechanismContact&) {
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
  MechanismCheck check_{std::vector<MechanismFrame>(1),
                        std::vector<MechanismBody>{{0, Pose(), one_sphere_tree({1, 0, 0}, 0.1)}},
                        std::vector<MechanismObstacle>{{Pose(), one_sphere_tree({1, 0, 0}, 0.5)}},
                        kOnePair,
                        0.0,
                        {.always_exact = true}};
  MechanismCheck::Scratch scratch_{check_};
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
  std::vector<MechanismFrame> frames;
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

  // By which the true spheres go into each other.
  double depth(std::size_t body, std::size_t obstacle, const std::vector<double>& at) const {
    const Sphere& other = obstacles[obstacle];
    return kTrueSize * (spheres[body].radius + other.radius) -
           (center(body, at) - other.center).norm();
  }

  MechanismCheck check(InstructionSet set) const {
    std::vector<MechanismBody> bodies;
    std::vector<MechanismObstacle> things;
    std::vector<MechanismPair> pairs;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      bodies.push_back(
          {static_cast<int>(i), Pose(), one_sphere_tree(spheres[i].center, spheres[i].radius)});
    }
    for (const Sphere& obstacle : obstacles) {
      things.push_back({Pose(), one_sphere_tree(obstacle.center, obstacle.radius)});
    }
    for (std::size_t i = 0; i < spheres.size() * obstacles.size(); ++i) {
      pairs.push_back({static_cast<int>(i % spheres.size()), static_cast<int>(i / spheres.size())});
    }
    return MechanismCheck(frames, bodies, things, pairs, 0.0,
                          {.instructions = set, .always_exact = true});
  }
};

// A closed way of the variables, slow; the obstacles stand where bodies come by.
struct Way {
  explicit Way(SceneRandom& random, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      start.push_back(random.uniform(-2.0, 2.0));
      rate.push_back(random.uniform(0.001, 0.006));
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

Arm random_arm(SceneRandom& random, const Way& way, int steps) {
  Arm arm;
  for (int f = 0; f < static_cast<int>(way.start.size()); ++f) {
    arm.frames.push_back({f - 1, random.pose(0.5), f, random.whole(0, 3) == 0});
    arm.spheres.push_back({random.point(0.3), random.uniform(0.05, 0.2)});
  }
  for (int i = 0; i < 6; ++i) {
    const auto body =
        static_cast<std::size_t>(random.whole(0, static_cast<int>(way.rate.size()) - 1));
    const Vector3d met = arm.center(body, way.at(random.whole(0, steps)));
    const double radius = random.uniform(0.05, 0.2);
    const double apart = random.uniform(0.7, 1.1) * (arm.spheres[body].radius + radius);
    arm.obstacles.push_back({met + apart * random.point(1.0).normalized(), radius});
  }
  return arm;
}

TEST(CoherenceCache, SavesQuestionsAndChangesNoAnswer) {
  constexpr int kSteps = 1500;
  SceneRandom random(91);
  int touching = 0, refused = 0, unasked = 0, asked_anew = 0, queried = 0;
  for (int i = 0; i < 12; ++i) {
    const Way way(random, 4);
    const Arm arm = random_arm(random, way, kSteps);
    for (const InstructionSet set : instruction_sets()) {
      const MechanismCheck check = arm.check(set);
      MechanismCheck::Scratch scratch(check);
      for (int step = 0; step < kSteps; ++step) {
        const std::vector<double> at = way.at(step);
        int questions = 0;
        const auto query = [&](MechanismCheck::Scratch& remembering) {
          questions = 0;
          return check.collides(at, remembering, [&](const MechanismContact& contact) {
            ++questions;
            const auto body = static_cast<std::size_t>(contact.pair.body);
            const double depth =
                arm.depth(body, static_cast<std::size_t>(contact.pair.obstacle), at);
            if (depth < 0.0) return false;
            const Sphere& sphere = arm.spheres[body];
            check.remember_contact(contact.pair.body,
                                   {sphere.center, Arm::kTrueSize * sphere.radius}, depth - 1e-12,
                                   remembering);
            return true;
          });
        };
        MechanismCheck::Scratch anew(check);
        const bool truth = query(anew);
        const int all_questions = questions;
        ASSERT_EQ(query(scratch), truth) << i << " at step " << step;
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

// Kernels in double precision for bodies of one sphere, each turned about an axis of its own. They
// count pairs that are searched.
struct PlainKernels {
  static void place(const KernelProblem& problem, const double* configuration,
                    const KernelScratch& scratch) {
    for (int f = 0; f < problem.frame_count; ++f) {
      const double c = std::cos(configuration[f]), s = std::sin(configuration[f]);
      const auto& o = problem.frames[f].origin;
      scratch.poses[f] = {{{c, s, 0, 0}, {-s, c, 0, 0}, {0, 0, 1, 0}, {o[0], o[1], o[2], 0}}};
    }
  }

  static double gap(const KernelProblem& problem, KernelPair pair, const KernelScratch& scratch) {
    const internal::KernelBody& body = problem.bodies[pair.body];
    const internal::KernelObstacle& obstacle = problem.obstacles[pair.obstacle];
    const auto& at = scratch.poses[body.frame].columns;
    Vector3d between;
    for (int k = 0; k < 3; ++k) {
      between[k] = at[0][k] * body.center[0] + at[1][k] * body.center[1] +
                   at[2][k] * body.center[2] + at[3][k] - static_cast<double>(obstacle.center[k]);
    }
    return between.norm() - static_cast<double>(body.radius) - static_cast<double>(obstacle.radius);
  }

  static KernelFinding test(const KernelProblem& problem, KernelPair pair, float inflation,
                            const KernelScratch& scratch, internal::ConfirmContact, void*) {
    ++*scratch.queues.generation;
    return gap(problem, pair, scratch) > static_cast<double>(inflation) ? KernelFinding::kApart
                                                                        : KernelFinding::kNear;
  }

  static bool check(const KernelProblem& problem, const double* configuration,
                    const KernelScratch& scratch, internal::ConfirmContact, void*) {
    place(problem, configuration, scratch);
    return std::any_of(problem.pairs, problem.pairs + problem.pair_count, [&](KernelPair pair) {
      ++*scratch.queues.generation;
      return gap(problem, pair, scratch) <= 0.0;
    });
  }
};

// Bodies that come straight at an obstacle each, or pass it by: touch it slightly or miss it by
// little.
struct Turntables {
  static constexpr int kBodies = 4;
  static constexpr float kRadius = 0.125F;

  Turntables(SceneRandom& random, const Way& way, int steps, bool straight) {
    for (int k = 0; k < kBodies; ++k) {
      const auto n = static_cast<std::size_t>(k);
      const Vector3d origin = random.point(0.5), center = random.point(1.0);
      for (int j = 0; j < 3; ++j) frames[n].rotation[j][j] = 1.0;
      std::copy_n(origin.data(), 3, frames[n].origin);
      frames[n].parent = -1;
      frames[n].variable = k;
      std::copy_n(center.data(), 3, bodies[n].center);
      bodies[n].radius = obstacles[n].radius = kRadius;
      bodies[n].frame = k;
      reach[n] = origin.norm() + center.norm() + kRadius;
      const Eigen::AngleAxisd turn(way.at(random.whole(0, steps))[n], Vector3d::UnitZ());
      const Vector3d met = origin + turn * center;
      const Vector3d side = straight ? random.point(1.0).normalized() : Vector3d::UnitZ();
      const Vector3d beside = met + 2.0 * kRadius * (1.0 + random.uniform(-1e-3, 1e-2)) * side;
      for (int j = 0; j < 3; ++j) obstacles[n].center[j] = static_cast<float>(beside[j]);
      pairs[n] = {k, k};
    }
  }

  KernelProblem problem() const {
    KernelProblem result = {};
    result.frames = frames.data();
    result.bodies = bodies.data();
    result.obstacles = obstacles.data();
    result.pairs = pairs.data();
    result.frame_count = result.variable_count = kBodies;
    result.body_count = result.pair_count = kBodies;
    return result;
  }

  std::array<KernelFrame, kBodies> frames{};
  std::array<internal::KernelBody, kBodies> bodies{};
  std::array<internal::KernelObstacle, kBodies> obstacles{};
  std::array<KernelPair, kBodies> pairs{};
  std::array<double, kBodies> reach{};  // of points from the root
};

TEST(CoherenceCache, SavesSearchesAndOverlooksNoTouch) {
  constexpr int kSteps = 20000;
  const Kernels kernels = {&PlainKernels::check, nullptr, &PlainKernels::place,
                           &PlainKernels::test};
  SceneRandom random(92);
  int touching = 0, close = 0;
  std::uint64_t searches = 0, all_searches = 0;
  for (int i = 0; i < 40; ++i) {
    const Way way(random, Turntables::kBodies);
    const Turntables tables(random, way, kSteps, i % 4 != 0);
    const KernelProblem problem = tables.problem();
    std::array<KernelPose, Turntables::kBodies> poses = {};
    KernelScratch scratch = {};
    scratch.poses = poses.data();
    CoherenceCache memory(problem, tables.reach, std::array<double, Turntables::kBodies>{});
    for (int step = 0; step < kSteps; ++step) {
      const std::vector<double> at = way.at(step);
      scratch.queues.generation = &all_searches;
      const bool truth = kernels.check(problem, at.data(), scratch, nullptr, nullptr);
      close += std::any_of(tables.pairs.begin(), tables.pairs.end(), [&](KernelPair pair) {
        return std::abs(PlainKernels::gap(problem, pair, scratch)) < 1e-4;
      });
      scratch.queues.generation = &searches;
      ASSERT_EQ(memory.collides(kernels, problem, at.data(), scratch, nullptr, nullptr), truth)
          << i << " at step " << step;
      touching += truth;
    }
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(close, 1000);
  EXPECT_LT(searches, all_searches / 2);
}

}  // namespace
}  // namespace spherule::test
