// SPDX-License-Identifier: BSD-3-Clause
// Remembered answers against collides() on walks of large and tiny steps.

#include "collide/pair_cache.h"

#include "spheretree/build.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test {
namespace {

// A body that wanders through a box about another one, by steps of all sizes.
class Walk {
 public:
  Walk(SceneRandom& random, double size, double step) : random_(random), size_(size), step_(step) {}

  Pose next() {
    const double step = step_ * std::ldexp(1.0, random_.whole(-4, 0));
    place_ += random_.point(step);
    for (double& x : place_) x = std::clamp(x, -size_, size_);
    const Eigen::Vector3d turn = random_.point(0.5 * step / size_);
    rotation_ = (Eigen::Quaterniond(1.0, turn.x(), turn.y(), turn.z()) * rotation_).normalized();
    return Pose(rotation_, place_);
  }

 private:
  SceneRandom& random_;
  double size_;
  double step_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

TEST(PairCache, AnswersAsCollidesDoes) {
  SceneRandom random(1);
  std::uint64_t free = 0;
  std::uint64_t hits = 0;
  std::uint64_t queries = 0;
  int colliding = 0;
  for (int i = 0; i < 60; ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const SphereTree a = build_tree(random_spheres(random, 60, size, 0.1 * size));
    const SphereTree b = build_tree(random_spheres(random, 60, 0.5 * size, 0.05 * size));
    PairCache cache(a, b);
    PairCache swapped(b, a);
    Walk walk_a(random, size, size * std::ldexp(1.0, -random.whole(0, 12)));
    Walk walk_b(random, 3.0 * size, size * std::ldexp(1.0, -random.whole(0, 12)));
    const Eigen::Vector3d far = random.point(1e6 * size * random.whole(0, 1));
    for (int k = 0; k < 1000; ++k) {
      Pose pose_a = walk_a.next();
      Pose pose_b = walk_b.next();
      pose_a = Pose(pose_a.rotation(), pose_a.translation() + far);
      pose_b = Pose(pose_b.rotation(), pose_b.translation() + far);
      const bool truth = collides(a, pose_a, b, pose_b);
      ASSERT_EQ(cache.collides(pose_a, pose_b), truth);
      ASSERT_EQ(swapped.collides(pose_b, pose_a), truth);
      colliding += truth;
    }
    free += cache.counts().free_from_memory;
    hits += cache.counts().collisions_from_memory;
    queries += cache.counts().queries;
  }
  EXPECT_EQ(queries, 60'000u);
  EXPECT_GT(colliding, 5000);
  EXPECT_GT(free, 5000u);
  EXPECT_GT(hits, 5000u);
}

// Towards contact by steps that shrink with the gap, so that the memory is queried at its limit.
TEST(PairCache, IsNotFooledNextToContact) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  SceneRandom random(2);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d direction = random.point(1.0).normalized();
    PairCache cache(sphere, sphere);
    double gap = 1.0;
    for (int k = 0; k < 80; ++k) {
      const Pose pose(random.quaternion(), (2.0 + gap) * direction);
      ASSERT_EQ(cache.collides(Pose(), pose), collides(sphere, Pose(), sphere, pose)) << gap;
      gap *= random.uniform(0.3, 0.9);
    }
    const Pose touching = Pose::from_translation(2.0 * direction);
    ASSERT_EQ(cache.collides(Pose(), touching), collides(sphere, Pose(), sphere, touching));
  }
}

TEST(PairCache, ARestingPairIsSearchedOnce) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  PairCache cache(sphere, sphere);
  const Pose near = Pose::from_translation({2.5, 0.0, 0.0});
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(cache.collides(Pose(), near));
  EXPECT_EQ(cache.counts().free_from_memory, 9u);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(cache.collides(Pose(), Pose()));
  EXPECT_EQ(cache.counts().collisions_from_memory, 9u);
  EXPECT_EQ(cache.counts().queries, 20u);
}

}  // namespace
}  // namespace spherule::test
