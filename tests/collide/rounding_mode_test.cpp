// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/rounding_mode.h"

#include "base/rounding.h"
#include "collide/mechanism/mechanism_check.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/pair_cache.h"
#include "spheretree/build.h"
#include "spheretree/check.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <vector>

namespace spherule::test::rounding_mode_test {
namespace {

TEST(RoundingMode, OthersAreRefused) {
  const std::vector<Sphere> spheres{{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
  const SphereTree tree = build_tree(spheres);
  const MechanismCheck mechanism({}, {}, {}, {}, 0.0);
  const TriangleMesh cube = cube_mesh();
  expect_rounding_to_nearest_is_needed([] { require_rounding_to_nearest(); }, "test");
  expect_rounding_to_nearest_is_needed([&] { build_tree(spheres); }, "build_tree");
  expect_rounding_to_nearest_is_needed([&] { MeshTree{cube}; }, "MeshTree");
  expect_rounding_to_nearest_is_needed([&] { refit(tree, spheres); }, "refit");
  expect_rounding_to_nearest_is_needed([&] { check(tree); }, "check");
  expect_rounding_to_nearest_is_needed([&] { SphereTree{tree.data()}; }, "SphereTree");
  expect_rounding_to_nearest_is_needed([&] { PairCache(tree, tree); }, "PairCache");
  expect_rounding_to_nearest_is_needed([&] { MechanismCheck::Scratch{mechanism}; }, "Scratch");
}

}  // namespace
}  // namespace spherule::test::rounding_mode_test
