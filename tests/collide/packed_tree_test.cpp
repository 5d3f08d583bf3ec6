// SPDX-License-Identifier: BSD-3-Clause
#include "collide/search/packed_tree.h"

#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

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
  SceneRandom random(11);
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

}  // namespace
}  // namespace spherule::test
