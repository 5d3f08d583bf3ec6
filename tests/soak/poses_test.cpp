// SPDX-License-Identifier: BSD-3-Clause
// Relative poses of two trees: collides(), collide(), within(), PairCache and distance() against
// all pairs of spheres in exact arithmetic.
#include "collide/collide.h"
#include "collide/pair_cache.h"
#include "tests/soak/exact_oracle.h"
#include "tests/soak/random_scene.h"
#include "tests/soak/scale.h"
#include "tests/soak/tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace spherule::test {
namespace {

constexpr int kPosesOfAScene = 200;
constexpr double kNear = 0.36;  // share of poses made near contact, a little above a third

Verdict verdict_of(bool hit) {
  return hit ? Verdict::kCollision : Verdict::kFree;
}

struct Placed {
  PosePair poses;
  bool is_near = false;
};

// A pose, near a gap of `clearance` or anywhere.
Placed make_poses(const ScenePair& scene, SoakRandom& random, double clearance) {
  if (random.chance(kNear)) {
    for (int attempt = 0; attempt < 4; ++attempt) {
      if (const auto poses = scene.at_gap(random, clearance + random.small_gap())) {
        return {*poses, true};
      }
    }
  }
  return {scene.anywhere(random), false};
}

// A little further, so that a cache can answer from memory.
Pose nudged(const Pose& pose, SoakRandom& random, double size) {
  const double step = random.magnitude(1e-14, 1e-2);
  Eigen::Quaterniond turn = pose.rotation();
  if (random.chance(0.5)) turn.vec() += step * turn.norm() * random.in_cube(1.0);
  return Pose(turn, pose.translation() + step * size * random.direction());
}

std::string text(const PlacedSet& a, const PlacedSet& b) {
  return "poses " + to_text(a.world_from_set) + " and " + to_text(b.world_from_set);
}

class PoseCheck {
 public:
  void run(const ScenePair& scene, SoakRandom& random) {
    PairCache cache(scene.a(), scene.b());
    for (int i = 0; i < kPosesOfAScene; ++i) {
      const auto [poses, is_near] = make_poses(scene, random, 0.0);
      query(scene, poses, is_near, cache, random);
      if (i % 4 == 0) check_within(scene, random);
    }
  }

  std::uint64_t poses() const { return collides_.cases; }
  void expect_telling() const {
    for (const Tally* tally : {&collides_, &swapped_, &limited_, &cached_, &within_}) {
      tally->expect_telling();
    }
  }

 private:
  void judge(Tally& tally, const PlacedSet& a, const PlacedSet& b, Verdict verdict, bool truth,
             bool is_near, double clearance, double slack) {
    tally.count(verdict, is_near);
    if (verdict == Verdict::kFree && truth) tally.add_fault("missed, " + text(a, b));
    if (verdict == Verdict::kCollision && !truth && oracle_.gap(a, b).lower - clearance > slack) {
      tally.add_fault("slack, " + text(a, b));
    }
  }

  void query(const ScenePair& scene, const PosePair& poses, bool is_near, PairCache& cache,
             SoakRandom& random) {
    const Pose& to_a = poses.world_from_a;
    const Pose& to_b = poses.world_from_b;
    const PlacedSet a{scene.a().spheres(), to_a}, b{scene.b().spheres(), to_b};
    const bool truth = oracle_.within(a, b, 0.0);
    const double slack = collision_slack(scene.a(), to_a, scene.b(), to_b);
    const bool said = collides(scene.a(), to_a, scene.b(), to_b);
    judge(collides_, a, b, verdict_of(said), truth, is_near, 0.0, slack);

    check_cache(scene, poses, is_near, cache);
    if (random.chance(0.2)) {
      check_cache(scene, {to_a, nudged(to_b, random, scene.size())}, false, cache);
    }
    if (random.chance(0.2)) approach(scene, random, cache);

    const int kind = random.whole(0, 7);
    if (kind == 0) {
      const bool swapped = collides(scene.b(), to_b, scene.a(), to_a);
      judge(swapped_, a, b, verdict_of(swapped), truth, is_near, 0.0, slack);
      if (swapped != said) swapped_.add_fault(text(a, b));
    } else if (kind == 1) {
      CollisionRequest request{.max_pairs = 1};
      if (random.chance(0.5)) {
        request.max_node_tests = static_cast<std::uint64_t>(random.whole(0, 30));
      }
      const CollisionResult result = collide(scene.a(), to_a, scene.b(), to_b, request);
      judge(limited_, a, b, result.verdict, truth, is_near, 0.0, slack);
      if (result.distance_lower_bound > 0.0 &&
          result.distance_lower_bound > oracle_.gap(a, b).upper) {
        limited_.add_fault("lower bound, " + text(a, b));
      }
    }
  }

  // From a clearance that the cache knows, straight on to contact or close to it.
  void approach(const ScenePair& scene, SoakRandom& random, PairCache& cache) {
    const double gap = random.magnitude(1e-9, 1.0) * scene.size();
    const auto start = scene.at_gap(random, gap);
    if (!start) return;
    check_cache(scene, *start, false, cache);
    const Pose& to_b = start->world_from_b;
    const double way = gap - random.small_gap();
    const Pose end(to_b.rotation(), to_b.translation() - way * start->way);
    check_cache(scene, {start->world_from_a, end}, true, cache);
  }

  // The cache has to answer as collides() does.
  void check_cache(const ScenePair& scene, const PosePair& poses, bool is_near, PairCache& cache) {
    const Pose& to_a = poses.world_from_a;
    const Pose& to_b = poses.world_from_b;
    const PlacedSet a{scene.a().spheres(), to_a}, b{scene.b().spheres(), to_b};
    const bool said = cache.collides(to_a, to_b);
    judge(cached_, a, b, verdict_of(said), oracle_.within(a, b, 0.0), is_near, 0.0,
          collision_slack(scene.a(), to_a, scene.b(), to_b));
    if (said != collides(scene.a(), to_a, scene.b(), to_b)) {
      cached_.add_fault("another answer, " + text(a, b));
    }
  }

  void check_within(const ScenePair& scene, SoakRandom& random) {
    const double clearance = random.chance(0.1) ? 0.0 : random.magnitude(1e-12, 1.0) * scene.size();
    const auto [poses, is_near] = make_poses(scene, random, clearance);
    const Pose& to_a = poses.world_from_a;
    const Pose& to_b = poses.world_from_b;
    const PlacedSet a{scene.a().spheres(), to_a}, b{scene.b().spheres(), to_b};
    const bool truth = oracle_.within(a, b, clearance);
    const bool said = within(scene.a(), to_a, scene.b(), to_b, clearance);
    judge(within_, a, b, verdict_of(said), truth, is_near, clearance,
          within_slack(scene.a(), to_a, scene.b(), to_b, clearance));
  }

  ExactOracle oracle_;
  Tally collides_{"collides"};
  Tally swapped_{"collides, exchanged"};
  Tally limited_{"collide, limited"};
  Tally cached_{"pair cache"};
  Tally within_{"within"};
};

DistanceRequest random_request(SoakRandom& random, double size) {
  DistanceRequest request;
  switch (random.whole(0, 3)) {
    case 0:
      request.tolerance = random.magnitude(1e-9, 1.0) * size;
      break;
    case 1:
      request.enough = random.magnitude(1e-6, 1.0) * size;
      break;
    case 2:
      request.max_node_tests = static_cast<std::uint64_t>(random.whole(0, 60));
      break;
    default:
      break;
  }
  return request;
}

TEST(ManyPoses, AreAnsweredRight) {
  SoakRandom random(seeded(7));
  PoseCheck check;
  const auto poses = static_cast<std::uint64_t>(scaled(20'000));
  while (check.poses() < poses) check.run(ScenePair(random), random);
  check.expect_telling();
}

TEST(ManyPoses, DistancesAreBounded) {
  SoakRandom random(seeded(8));
  ExactOracle oracle;
  Tally tally{"distance"};
  const auto distances = static_cast<std::uint64_t>(scaled(5'000));
  while (tally.cases < distances) {
    const ScenePair scene(random);
    for (int i = 0; i < kPosesOfAScene; ++i) {
      const auto [poses, is_near] = make_poses(scene, random, 0.0);
      const Pose& to_a = poses.world_from_a;
      const Pose& to_b = poses.world_from_b;
      const DistanceResult result =
          distance(scene.a(), to_a, scene.b(), to_b, random_request(random, scene.size()));
      const PlacedSet a{scene.a().spheres(), to_a}, b{scene.b().spheres(), to_b};
      const GapBounds gap = oracle.gap(a, b);
      const long double zero = 0.0;
      const long double least = std::max(gap.lower, zero), most = std::max(gap.upper, zero);
      tally.count(result.upper == 0.0  ? Verdict::kCollision
                  : result.lower > 0.0 ? Verdict::kFree
                                       : Verdict::kUnknown,
                  is_near);
      // Where the bounds of the oracle are uncertain, its exact test is not.
      const bool is_lower_right =
          result.lower <= least || (result.lower <= most && !oracle.within(a, b, result.lower));
      const bool is_upper_right =
          result.upper >= most || (result.upper >= least && oracle.within(a, b, result.upper));
      if (!is_lower_right || !is_upper_right) {
        tally.add_fault(text(a, b));
      }
    }
  }
  tally.expect_telling();
}

// Exactly touching, and by the smallest step on either side of it.
TEST(ExactOracle, IsExact) {
  ExactOracle oracle;
  const std::array<Sphere, 1> a{{{{0.0, 0.0, 0.0}, 2.0}}};
  const std::array<Sphere, 1> b{{{{3.0, 4.0, 0.0}, 3.0}}};
  // A turn by (3, 4) / 5, which has no exact unit quaternion in double.
  const Pose turned(Eigen::Quaterniond(2.0, 0.0, 0.0, 1.0), {1e6, 0.0, 0.0});
  const auto within = [&](double x, double clearance) {
    return oracle.within({a, turned}, {b, Pose(turned.rotation(), {x, 0.0, 0.0})}, clearance);
  };
  // The image of (3, 4, 0) is (9 - 16, 12 + 12, 0) / 5 = (-1.4, 4.8, 0), again 5 long.
  EXPECT_TRUE(within(1e6, 0.0));
  EXPECT_FALSE(within(std::nextafter(1e6, 0.0), 0.0));
  EXPECT_TRUE(within(std::nextafter(1e6, 2e6), 0.0));
  EXPECT_TRUE(within(std::nextafter(1e6, 0.0), 1e-9));
  EXPECT_GE(oracle.rational_pairs(), 1u);
  const GapBounds gap = oracle.gap({a, turned}, {b, turned});
  EXPECT_LE(gap.lower, 0.0L);
  EXPECT_GE(gap.upper, 0.0L);
}

}  // namespace

}  // namespace spherule::test
