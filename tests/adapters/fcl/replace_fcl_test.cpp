// SPDX-License-Identifier: BSD-3-Clause
// One program, compiled for FCL and for spherule: what it finds with the one and with the other.
#include "adapters/fcl/collide.h"
#include "tests/adapters/fcl/models.h"
#include "tests/adapters/fcl/same_program.h"
#include "tests/support/effort.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using test::PairAnswer;
using test::PlacedPair;
using test::ProgramModel;

// The simplified solid of a convex mesh is the mesh and what stands between the external spheres.
constexpr double kScallops = 0.02;
constexpr double kFclDistanceError = 1e-9;

const std::vector<std::string> kNames =
    test::effort(std::vector<std::string>{"cube", "bracket", "cylinder"}, 1);

struct Scene {
  std::vector<ProgramModel> models;
  std::vector<FclSolid> solids;
  std::vector<PlacedPair> pairs;
};

Scene make_scene(bool confirm_on_triangles, int lines, std::uint64_t seed) {
  Scene scene;
  for (const std::string& name : kNames) {
    const TriangleMesh mesh = test::fcl_test_mesh(name);
    scene.models.push_back({mesh, test::fcl_test_error(mesh), confirm_on_triangles});
    scene.solids.emplace_back(mesh);
  }
  test::Random random(seed);
  for (std::size_t a = 0; a < kNames.size(); ++a) {
    for (std::size_t b = a; b < kNames.size(); ++b) {
      for (const auto& [tf_a, tf_b] :
           test::transforms_near_contact(scene.solids[a], scene.solids[b], lines, random)) {
        scene.pairs.push_back({a, b, tf_a, tf_b});
      }
    }
  }
  return scene;
}

bool touches(const Scene& scene, const PlacedPair& pair) {
  return touch(scene.solids[pair.a], fcl_api::from_fcl(pair.tf_a), scene.solids[pair.b],
               fcl_api::from_fcl(pair.tf_b));
}

// How far the spheres of a model may reach from its mesh.
double bound_of(std::size_t model) {
  const std::string& name = kNames[model];
  if (name == "bracket") {  // what the external spheres do not reach is no part of it
    return test::covered_model(name)->part().certificate->protrusion_over_mesh->upper;
  }
  return (1.0 + kScallops) * test::fcl_test_error(test::fcl_test_mesh(name));
}

TEST(ReplaceFcl, NoCollisionIsMissedAndExtrasAreNear) {
  const Scene scene = make_scene(false, test::effort(30, 4), 1);
  const auto with_fcl = query_pairs_fcl(scene.models, scene.pairs, true);
  const auto with_spheres = query_pairs_spherule(scene.models, scene.pairs, true);
  std::size_t collisions = 0, missed = 0, extra = 0, inside = 0;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    const PlacedPair& pair = scene.pairs[i];
    const PairAnswer& fcl = with_fcl[i];
    const PairAnswer& ours = with_spheres[i];
    EXPECT_EQ(fcl.geometry_collides, fcl.object_collides);
    EXPECT_EQ(ours.geometry_collides, ours.object_collides);
    collisions += fcl.object_collides;
    missed += fcl.object_collides && !ours.object_collides;
    if (ours.object_collides && !fcl.object_collides) {
      if (touches(scene, pair)) {
        ++inside;
      } else {
        ++extra;
        EXPECT_LE(fcl.distance, bound_of(pair.a) + bound_of(pair.b)) << i;
      }
    }
    if (!ours.object_collides) {
      EXPECT_GT(ours.distance, 0.0);
      EXPECT_LE(ours.distance, fcl.distance * (1.0 + kFclDistanceError));
      EXPECT_GE(ours.distance, fcl.distance - bound_of(pair.a) - bound_of(pair.b));
    }
  }
  std::cout << scene.pairs.size() << " pairs: " << collisions << " collide by FCL, " << missed
            << " missed, " << inside << " one inside the other, " << extra << " extra\n";
  EXPECT_EQ(missed, 0u);
  EXPECT_GT(collisions, scene.pairs.size() / 10);
  EXPECT_GT(extra, 0u);
}

// Confirmed on the triangles, the verdict is FCL's or that one is inside the other.
TEST(ReplaceFcl, ConfirmedVerdictsAreFcls) {
  const Scene scene = make_scene(true, test::effort(30, 4), 2);
  const auto with_fcl = query_pairs_fcl(scene.models, scene.pairs, false);
  const auto ours = query_pairs_spherule(scene.models, scene.pairs, false);
  std::size_t different = 0, collisions = 0;
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    const bool expected = with_fcl[i].object_collides || touches(scene, scene.pairs[i]);
    collisions += expected;
    different += ours[i].object_collides != expected;
    EXPECT_EQ(ours[i].geometry_collides, ours[i].object_collides);
  }
  std::cout << scene.pairs.size() << " pairs, " << collisions << " collide\n";
  EXPECT_EQ(different, 0u);
  EXPECT_GT(collisions, scene.pairs.size() / 10);
  EXPECT_LT(collisions, scene.pairs.size() * 9 / 10);
}

// Whatever manager of FCL's culls, the pairs are those of the brute-force one, for both.
TEST(ReplaceFcl, AllManagersFindWhatBruteForceFinds) {
  const std::vector<std::string> managers = {
      "Naive", "DynamicAABBTree", "DynamicAABBTreeArray", "SaP", "SSaP", "IntervalTree"};
  test::Random random(3);
  std::vector<ProgramModel> models;
  for (const std::string& name : test::effort(std::vector<std::string>{"cube", "bracket"}, 1)) {
    const TriangleMesh mesh = test::fcl_test_mesh(name);
    models.push_back({mesh, test::fcl_test_error(mesh), false});
  }
  std::vector<test::PlacedModel> objects;
  for (int i = 0; i < 60; ++i) {
    fcl::Transform3d tf = test::random_transform(random, 400.0);
    if (i % 4 == 0) tf.linear().setIdentity();  // FCL makes the boxes of these in another way
    objects.push_back({random.index(models.size()), tf});
  }
  const auto by_fcl = query_managers_fcl(managers, models, objects);
  const auto by_spheres = query_managers_spherule(managers, models, objects);
  for (std::size_t i = 1; i < managers.size(); ++i) {
    EXPECT_EQ(by_fcl[i], by_fcl[0]) << managers[i];
    EXPECT_EQ(by_spheres[i], by_spheres[0]) << managers[i];
  }
  EXPECT_TRUE(std::includes(by_spheres[0].begin(), by_spheres[0].end(), by_fcl[0].begin(),
                            by_fcl[0].end()));
  EXPECT_GT(by_fcl[0].size(), 20u);
  EXPECT_GT(by_spheres[0].size(), by_fcl[0].size());
}

}  // namespace
}  // namespace spherule
