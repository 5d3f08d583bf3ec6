// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "collide/collide.h"
#include "collide/meshes/patch_trees.h"
#include "collide/pair_cache.h"
#include "collide/point_cloud.h"
#include "collide/search/packed_tree.h"
#include "collide/search/traversal.h"
#include "spheretree/sphere_tree.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// The stack of the traversal on the deepest trees there can be: within its proved bound, and
// nothing dropped.

// Visits every pair of leaves that is not pruned.
struct CountLeaves {
  static constexpr bool kNeedsGaps = false;
  std::size_t count = 0;

  bool afford(const internal::OpenedPair&, const auto&) { return true; }
  bool leaves(internal::NodePair) {
    ++count;
    return true;
  }
};

struct Peak {
  std::size_t entries = 0;  // highest entry written, plus one
  std::size_t leaf_pairs = 0;
};

// Runs on a stack of exactly the proved size, with watched entries behind it.
Peak traverse_on_tight_stack(const SphereTree& a, const SphereTree& b) {
  const internal::NodePair untouched(-7, -7);
  const std::size_t bound = internal::traversal_stack_bound(a, b);
  std::vector<internal::NodePair> stack(bound + 64, untouched);
  const Pose origin;
  const internal::RelativePose pose(a, origin, b, origin);
  CountLeaves policy;
  EXPECT_TRUE(
      internal::traverse_with(stack.data(), bound, internal::TreePair(a, b, pose), pose, policy));
  Peak peak{0, policy.count};
  for (std::size_t i = 0; i < stack.size(); ++i) {
    if (!(stack[i] == untouched)) peak.entries = i + 1;
  }
  EXPECT_LE(peak.entries, bound);
  return peak;
}

TEST(Traversal, StaysWithinTheProvedStackAndDropsNothing) {
  for (const int branching : {1, 2, 3, 8, 16}) {
    for (const int depth : {1, 2, 7, 40}) {
      for (const bool inner_first : {false, true}) {
        const SphereTree a = caterpillar(depth, branching, inner_first);
        const SphereTree b = caterpillar(depth / 2 + 1, branching, inner_first);
        const Peak peak = traverse_on_tight_stack(a, b);
        EXPECT_EQ(peak.leaf_pairs, a.spheres().size() * b.spheres().size());
        // The bound is no larger than it must be: the worst order reaches it.
        if (!inner_first) {
          EXPECT_EQ(peak.entries, internal::traversal_stack_bound(a, b));
        }
      }
    }
  }
}

// The bound on the depth that build_tree() gives, for a million spheres and the widest nodes.
TEST(Traversal, InlineStackIsEnoughForAMillionSpheres) {
  const std::size_t log2 = std::bit_width(std::size_t{1'000'000 - 1});
  const std::size_t deepest = 3 * log2 + 9;
  EXPECT_GE(internal::kInlineStack, 2 * deepest * (SphereTree::kMaxBranching - 1) + 1);
}

TEST(Traversal, TakesTreesThatOutgrowTheInlineStack) {
  const SphereTree a = caterpillar(1100, 2, false);
  const SphereTree b = caterpillar(1300, 2, true);
  ASSERT_GT(internal::traversal_stack_bound(a, b), internal::kInlineStack);
  EXPECT_TRUE(collides(a, Pose(), b, Pose()));
  const CollisionResult result = collide(a, Pose(), b, Pose());
  EXPECT_EQ(result.pairs.size(), a.spheres().size() * b.spheres().size());
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(collides(a, Pose(), b, Pose::from_translation({5000.0, 0.0, 0.0})));
  // Deep inside each other by the inner spheres and by the boxes, but no leaf touches.
  EXPECT_FALSE(collides(a, Pose(), b, Pose::from_translation({1.3, 1.3, 1.3})));
}

TEST(Traversal, WithoutAStackFindsTheSamePairs) {
  const SphereTree a = caterpillar(20, 3, false);
  const SphereTree b = caterpillar(30, 4, true);
  const Pose origin;
  const internal::RelativePose pose(a, origin, b, origin);
  CountLeaves policy;
  EXPECT_TRUE(internal::traverse_exhaustively(a, b, internal::TreePair(a, b, pose), policy));
  EXPECT_EQ(policy.count, a.spheres().size() * b.spheres().size());
}

using internal::PackedNode;
using internal::PackedTree;

Sphere lane_of(const PackedNode& node, int lane) {
  return {{node.x[lane], node.y[lane], node.z[lane]}, node.radius[lane]};
}

// Goes down a packed tree and checks that every sphere has room for the inflated spheres below it.
class Inspection {
 public:
  Inspection(const SphereTree& tree, const PackedTree& packed, double inflation)
      : packed_(packed), spheres_(tree.spheres()), inflation_(inflation), seen_(spheres_.size()) {
    const std::vector<std::int32_t> all = visit(0, 1);
    expect_room(packed.root(), all);
    for (const int times : seen_) EXPECT_EQ(times, 1);
    EXPECT_EQ(deepest_, packed.depth());
  }

 private:
  std::vector<std::int32_t> visit(std::int32_t number, int depth) {
    deepest_ = std::max(deepest_, depth);
    const PackedNode& node = packed_.nodes()[number];
    std::vector<std::int32_t> below;
    for (int lane = 0; lane < PackedNode::kWidth; ++lane) {
      const Sphere sphere = lane_of(node, lane);
      if (sphere.center.x() > 1e18) {
        EXPECT_EQ(sphere.radius, 0.0);
        continue;
      }
      const std::int32_t child = node.child[lane];
      std::vector<std::int32_t> here{~child};
      if (child >= 0) {
        here = visit(child, depth + 1);
      } else {
        ++seen_[static_cast<std::size_t>(~child)];
        const double inflated = sphere.radius - spheres_[static_cast<std::size_t>(~child)].radius;
        EXPECT_LE(inflated, packed_.largest_inflation());
      }
      expect_room(sphere, here);
      below.insert(below.end(), here.begin(), here.end());
    }
    return below;
  }

  void expect_room(const Sphere& sphere, const std::vector<std::int32_t>& below) const {
    for (const std::int32_t i : below) {
      const Sphere& inner = spheres_[static_cast<std::size_t>(i)];
      const Real distance =
          sqrt(squared_distance(exact<Real>(sphere.center), exact<Real>(inner.center)));
      EXPECT_LE((distance + inner.radius + inflation_) * (1 + Real(0x1p-21)), Real(sphere.radius));
    }
  }

  const PackedTree& packed_;
  std::span<const Sphere> spheres_;
  double inflation_;
  std::vector<int> seen_;
  int deepest_ = 0;
};

TEST(PackedTree, EverySphereHasRoomForTheInflatedSpheresBelow) {
  Random random(11);
  for (const double size : {1e-6, 1.0, 1e6}) {
    for (const int count : {1, 2, 9, 300}) {
      for (const int branching : {2, 8}) {
        const SphereTree tree =
            build_tree(random_spheres(random, count, size, 0.1 * size), {.branching = branching});
        for (const double inflation : {0.0, 1e-6 * size, size}) {
          Inspection(tree, PackedTree(tree, inflation), inflation);
        }
      }
    }
  }
}

TEST(PackedTree, ADeepTreeIsPackedWhole) {
  const SphereTree tree = caterpillar(40, 3, true);
  Inspection(tree, PackedTree(tree, 1e-3), 1e-3);
}

// Trees of boxes over the triangles under a sphere.

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using internal::Patch;
using internal::PatchBox;
using internal::PatchNode;
using internal::PatchTrees;

// In exact arithmetic: a box in single precision about an origin in double.
bool encloses(const PatchBox& box, const Vector3d& origin, const AlignedBox3d& inner) {
  for (int k = 0; k < 3; ++k) {
    const Rational center = Rational(box.center[k]) + Rational(origin[k]);
    if (center - Rational(box.half[k]) > Rational(inner.min()[k])) return false;
    if (center + Rational(box.half[k]) < Rational(inner.max()[k])) return false;
  }
  return true;
}

// Every patch is below boxes that enclose it all the way down, and just once.
void check_below(const PatchTrees& trees, std::int32_t index, const Vector3d& origin,
                 const std::vector<Patch>& patches, std::vector<PatchBox>& above,
                 std::multiset<std::int32_t>& found) {
  ASSERT_LE(above.size(), PatchTrees::kMaxDepth);
  const PatchNode& node = trees.node(index);
  for (int i = 0; i < PatchNode::kWidth; ++i) {
    if (node.half[0][i] == -std::numeric_limits<float>::infinity()) continue;
    above.push_back(node.box(i));
    if (node.child[i] >= 0) {
      check_below(trees, node.child[i], origin, patches, above, found);
    } else {
      found.insert(~node.child[i]);
      const auto patch = std::find_if(patches.begin(), patches.end(),
                                      [&](const Patch& p) { return p.triangle == ~node.child[i]; });
      ASSERT_NE(patch, patches.end());
      for (const PatchBox& box : above) EXPECT_TRUE(encloses(box, origin, patch->box));
    }
    above.pop_back();
  }
}

TEST(PatchTrees, BoxesEncloseWhatIsBelowThem) {
  Random random(81);
  for (const int count : {1, 2, 7, 8, 9, 64, 65, 700}) {
    const Vector3d origin = random.point(count % 2 == 0 ? 1.0 : 1e5);
    std::vector<Patch> patches;
    for (int i = 0; i < count; ++i) {
      const Vector3d corner = origin + random.point(0.3);
      AlignedBox3d box(corner);
      if (random.whole(0, 5) != 0) box.extend(corner + random.point(0.1));
      patches.push_back({1, i, box});
    }
    const std::vector<Sphere> spheres = {{Vector3d::Zero(), 1.0}, {origin, 1.0}};
    const PatchTrees trees(patches, spheres);
    EXPECT_LT(trees.root(0).node, 0);
    std::vector<PatchBox> above = {trees.root(1).box};
    std::multiset<std::int32_t> found;
    check_below(trees, trees.root(1).node, origin, patches, above, found);
    EXPECT_EQ(found.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(std::set<std::int32_t>(found.begin(), found.end()).size(), found.size());
  }
}

TEST(PatchTrees, EveryMachineFindsTheSameOverlaps) {
  Random random(82);
  int overlapping = 0;
  for (int i = 0; i < 20000; ++i) {
    PatchNode node = {};
    PatchBox box = {};
    for (int k = 0; k < 3; ++k) {
      // Small whole numbers, so that boxes often just touch.
      box.center[k] = static_cast<float>(random.whole(-4, 4));
      box.half[k] = static_cast<float>(random.whole(0, 3));
      for (int lane = 0; lane < PatchNode::kWidth; ++lane) {
        node.center[k][lane] = static_cast<float>(random.whole(-4, 4));
        node.half[k][lane] = random.whole(0, 9) == 0 ? -std::numeric_limits<float>::infinity()
                                                     : static_cast<float>(random.whole(0, 3));
      }
    }
    const unsigned mask = internal::overlaps(node, box);
    ASSERT_EQ(mask, internal::portable_overlaps(node, box));
    for (int lane = 0; lane < PatchNode::kWidth; ++lane) {
      bool all = true;
      for (int k = 0; k < 3; ++k) {
        all = all &&
              std::abs(node.center[k][lane] - box.center[k]) <= node.half[k][lane] + box.half[k];
      }
      ASSERT_EQ((mask >> lane & 1U) != 0, all);
      overlapping += all;
    }
  }
  EXPECT_GT(overlapping, 10000);
}

// Remembered answers against collides() on walks of large and tiny steps.

// A body that wanders through a box about another one, by steps of all sizes.
class Walk {
 public:
  Walk(Random& random, double size, double step) : random_(random), size_(size), step_(step) {}

  Pose next() {
    const double step = step_ * std::ldexp(1.0, random_.whole(-4, 0));
    place_ += random_.point(step);
    for (double& x : place_) x = std::clamp(x, -size_, size_);
    const Eigen::Vector3d turn = random_.point(0.5 * step / size_);
    rotation_ = (Eigen::Quaterniond(1.0, turn.x(), turn.y(), turn.z()) * rotation_).normalized();
    return Pose(rotation_, place_);
  }

 private:
  Random& random_;
  double size_;
  double step_;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
};

// On walks, and now and then straight towards contact by steps that shrink with the gap, so that
// the memory is queried at its limit.
TEST(PairCache, AnswersAsCollidesDoes) {
  Random random(seeded(1));
  std::uint64_t free = 0, hits = 0;
  int colliding = 0, close = 0;
  for (int i = 0; i < scaled(60); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const SphereTree a = build_tree(random_spheres(random, i % 4 == 0 ? 1 : 60, size, 0.1 * size));
    const SphereTree b = build_tree(random_spheres(random, 60, 0.5 * size, 0.05 * size));
    PairCache cache(a, b);
    PairCache swapped(b, a);
    Walk walk_a(random, size, size * std::ldexp(1.0, -random.whole(0, 12)));
    Walk walk_b(random, 3.0 * size, size * std::ldexp(1.0, -random.whole(0, 12)));
    const Vector3d far = random.point(1e6 * size * random.whole(0, 1));
    Pose pose_a, pose_b;
    for (int k = 0; k < 1000; ++k) {
      DistanceResult gap;
      if (k % 100 > 0 && k % 100 < 40) gap = distance(a, pose_a, b, pose_b);
      if (gap.upper > 0.0 && std::isfinite(gap.upper)) {
        const auto center = [](const SphereTree& tree, std::int32_t index, const Pose& pose) {
          return Vector3d(pose * tree.spheres()[static_cast<std::size_t>(index)].center);
        };
        const Vector3d way = center(a, gap.nearest.a, pose_a) - center(b, gap.nearest.b, pose_b);
        pose_b = Pose(pose_b.rotation(), pose_b.translation() + gap.upper * way.normalized() *
                                                                    random.between(0.3, 1.0));
        close += gap.upper < 1e-9 * size;
      } else {
        const Pose next_a = walk_a.next(), next_b = walk_b.next();
        pose_a = Pose(next_a.rotation(), next_a.translation() + far);
        pose_b = Pose(next_b.rotation(), next_b.translation() + far);
      }
      const bool truth = collides(a, pose_a, b, pose_b);
      ASSERT_EQ(cache.collides(pose_a, pose_b), truth);
      ASSERT_EQ(swapped.collides(pose_b, pose_a), truth);
      colliding += truth;
    }
    free += cache.counts().free_from_memory;
    hits += cache.counts().collisions_from_memory;
  }
  EXPECT_GT(colliding, 3000);
  EXPECT_GT(close, 500);
  EXPECT_GT(free, 3000u);
  EXPECT_GT(hits, 1500u);
}

TEST(PairCache, ARestingPairIsSearchedOnce) {
  const SphereTree sphere = tree_of({Vector3d::Zero(), 1.0});
  PairCache cache(sphere, sphere);
  const Pose near = Pose::from_translation({2.5, 0.0, 0.0});
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(cache.collides(Pose(), near));
  EXPECT_EQ(cache.counts().free_from_memory, 9u);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(cache.collides(Pose(), Pose()));
  EXPECT_EQ(cache.counts().collisions_from_memory, 9u);
  EXPECT_EQ(cache.counts().queries, 20u);
}

std::vector<Vector3d> random_points(Random& random, int count, double size) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.point(size));
  return points;
}

// In rational numbers: |c - p| <= R - r.
bool contains_sphere(const Sphere& sphere, const Vector3d& point, double radius) {
  if ((sphere.center - point).norm() > sphere.radius * (1.0 + 1e-6)) return false;
  const Rational room = Rational(sphere.radius) - Rational(radius);
  return room >= 0 &&
         squared_distance(exact<Rational>(sphere.center), exact<Rational>(point)) <= room * room;
}

TEST(PointCloudTest, OneSphereForEveryPoint) {
  Random random(1);
  std::vector<Vector3d> points = random_points(random, 300, 2.0);
  const std::vector<Vector3d> twice = points;
  points.insert(points.end(), twice.begin(), twice.end());
  points.push_back({0.0, 0.0, 0.0});
  points.push_back({-0.0, 0.0, -0.0});
  const std::vector<Sphere> spheres = point_cloud_spheres(points, 0.25);
  ASSERT_EQ(spheres.size(), 301u);
  for (const Vector3d& point : points) {
    EXPECT_TRUE(std::any_of(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
      return sphere.center == point && sphere.radius == 0.25;
    }));
  }
}

TEST(PointCloudTest, CellsCoverTheSpheresOfTheirPoints) {
  Random random(2);
  for (int i = 0; i < effort(60, 4); ++i) {
    const double size = std::ldexp(1.0, random.whole(-30, 25));
    // Far from the origin as well, where cells are not much larger than what rounding leaves.
    const double far = random.whole(0, 1) * size * 1e6;
    const double voxel = size * std::ldexp(1.0, random.whole(-24, 2));
    const double radius = random.whole(0, 1) * size * random.between(0.0, 0.1);
    std::vector<Vector3d> points = random_points(random, 200, size);
    for (Vector3d& point : points) point += Vector3d(far, -far, far);
    const std::vector<Sphere> spheres = point_cloud_spheres(points, radius, {.voxel = voxel});
    ASSERT_LE(spheres.size(), points.size());
    std::vector<char> used(spheres.size(), 0);
    for (const Vector3d& point : points) {
      bool found = false;
      for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (!contains_sphere(spheres[k], point, radius)) continue;
        found = true;
        used[k] = 1;
      }
      ASSERT_TRUE(found) << i;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
    for (const Sphere& sphere : spheres) {
      ASSERT_LE(sphere.radius, radius + std::sqrt(0.75) * voxel + 1e-15 * (4.0 * far + 4.0 * size));
    }
    std::reverse(points.begin(), points.end());
    ASSERT_EQ(point_cloud_spheres(points, radius, {.voxel = voxel}), spheres);
  }
}

TEST(PointCloudTest, FewCellsForManyPoints) {
  Random random(3);
  const std::vector<Vector3d> points = random_points(random, 5000, 1.0);
  EXPECT_LE(point_cloud_spheres(points, 0.0, {.voxel = 0.5}).size(), 64u);
  EXPECT_EQ(point_cloud_spheres(points, 0.0, {.voxel = 1e-9}).size(), 5000u);
  EXPECT_LE(point_cloud_spheres(points, 0.0, {.voxel = 1e15}).size(), 8u);
  EXPECT_EQ(point_cloud_spheres(points, 0.0, {.voxel = 0x1p-1074}).size(), 5000u);
}

TEST(PointCloudTest, TheTreeIsOverTheSpheres) {
  Random random(4);
  const std::vector<Vector3d> points = random_points(random, 400, 1.0);
  const SphereTree tree = point_cloud_tree(points, 0.01, {.voxel = 0.1, .build = {.branching = 4}});
  EXPECT_TRUE(
      std::ranges::equal(tree.spheres(), point_cloud_spheres(points, 0.01, {.voxel = 0.1})));
  EXPECT_LE(tree.branching(), 4);
}

TEST(PointCloudTest, RefusesWhatIsNoCloud) {
  const std::vector<Vector3d> good = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  EXPECT_THROW(point_cloud_tree({}, 0.1), Error);
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 2e15}) {
    EXPECT_THROW(point_cloud_tree(good, bad), Error);
    EXPECT_THROW(point_cloud_tree(good, 0.1, {.voxel = bad}), Error);
    if (bad == -1.0) continue;
    std::vector<Vector3d> points = good;
    points.push_back({0.0, bad, 0.0});
    try {
      point_cloud_tree(points, 0.1);
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("point 2"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace spherule::test
