// SPDX-License-Identifier: BSD-3-Clause
// Trees of boxes over the triangles under a sphere.

#include "collide/meshes/patch_trees.h"

#include "base/rounding.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/scene_random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace spherule::test {
namespace {

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
  SceneRandom random(81);
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
  SceneRandom random(82);
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

}  // namespace
}  // namespace spherule::test
