// SPDX-License-Identifier: BSD-3-Clause
// Confirmed hits against FCL on the meshes with their insides: the same verdicts, none missed and
// none extra, down to a micrometre from contact.
#include "collide/meshes/mesh_contact.h"
#include "tests/collide_truth/fitted_model.h"
#include "tests/collide_truth/near_contact.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using test::FittedModel;

constexpr std::size_t kPoses = test::effort(1200, 100);

CoveredMesh covered(const FittedModel& model) {
  return {model.triangles, std::make_shared<const SphereTree>(model.tree)};
}

void expect_exact(const FittedModel& a, const FittedModel& b, std::uint64_t seed) {
  SCOPED_TRACE(a.name + " and " + b.name);
  const CoveredMesh covered_a = covered(a), covered_b = covered(b);
  test::Random random(seed);
  std::size_t poses = 0, touching = 0, missed = 0, extra = 0, alarms = 0, unequal = 0;
  for (const test::JudgedPose& pose : judged_poses(a, b, kPoses, random)) {
    const bool hit = collides(covered_a, pose.world_from_a, covered_b, pose.world_from_b);
    ++poses;
    touching += pose.touching;
    missed += pose.touching && !hit;
    extra += hit && !pose.touching;
    alarms += !pose.touching && collides(a.tree, pose.world_from_a, b.tree, pose.world_from_b);
    unequal += hit != collides(covered_b, pose.world_from_b, covered_a, pose.world_from_a);
  }
  std::cout << a.name << " and " << b.name << ": " << poses << " poses, " << touching
            << " touching, " << alarms << " false alarms of the spheres; confirmed: " << missed
            << " missed, " << extra << " extra\n";
  EXPECT_EQ(missed, 0u);
  EXPECT_EQ(extra, 0u);
  EXPECT_EQ(unequal, 0u);
  EXPECT_GT(touching, poses / 10);
  EXPECT_GT(alarms, poses / 10);
}

TEST(MeshContactTruth, OnShapes) {
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"cube", "probe"},     {"cube", "cube"},     {"torus", "cylinder"}, {"pipe", "bracket"},
      {"open-box", "probe"}, {"shells", "probe"},  {"soup", "sphere"},    {"torus", "probe"},
      {"plate", "cone"},     {"sphere", "sphere"}, {"shells", "soup"}};
  std::uint64_t seed = 1;
  for (const auto& [a, b] : test::effort(pairs, 2)) {
    expect_exact(test::shape_model(a), test::shape_model(b), ++seed);
  }
}

TEST(MeshContactTruth, OnRealModels) {
  if (!test::models_dir()) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const std::string kArm = "robots/abb_irb4400l/meshes/irb4400l_30_243/";
  const FittedModel& pipes = test::real_model("parts/three_pipes.stl", 1);
  const FittedModel& gear = test::real_model("parts/spur_gear_m2_z24.stl", 1);
  expect_exact(test::real_model(kArm + "visual/link_4.stl", 1000), pipes, 21);
  expect_exact(test::real_model("torch/torch.stl", 10), pipes, 22);
  expect_exact(gear, gear, 23);
  expect_exact(test::real_model("parts/sealed_housing_with_core.stl", 1), gear, 24);
}

}  // namespace
}  // namespace spherule
