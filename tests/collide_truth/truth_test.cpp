// SPDX-License-Identifier: BSD-3-Clause
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "tests/collide_truth/fitted_model.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// The whole chain against FCL on the meshes themselves: mesh, spheres, tree, collision. No contact
// of the meshes may be missed, and where we say "collision" and the meshes are apart, they are
// nearer than the two certified protrusions and the slack of the query.

// A relative error that FCL's own distance may have.
constexpr double kFclDistanceError = 1e-9;
constexpr std::size_t kDefaultPoses = effort(100000, 800);

// Poses of all pairs of the plain shapes together; SPHERULE_TEST_POSES sets another number.
std::size_t total_poses() {
  const char* text = std::getenv("SPHERULE_TEST_POSES");
  return text == nullptr || *text == '\0' ? kDefaultPoses : std::strtoull(text, nullptr, 10);
}

struct Tally {
  std::size_t poses = 0, touching = 0, missed = 0, extra = 0;
  double worst_excess = -1e300;  // of an extra's distance over the bound
  double worst_share = 0.0;      // of the bound
  // The same by the two E, which bound the protrusion over the simplified solids (G2).
  double worst_share_of_errors = 0.0;
};

// Every point near a convex body can be reached from outside, so that its simplified solid is the
// body and what stands between the external spheres: along a flat wall some 0.02 E, for the grid
// step that stage 1 chooses (ExternalOptions::grid_step).
constexpr double kScallops = 0.02;

bool is_convex(const FittedModel& model) {
  const auto names = {"cube", "slab", "sphere", "cylinder", "cone"};
  return std::find(names.begin(), names.end(), model.name) != names.end();
}

Tally compare(const FittedModel& a, const FittedModel& b, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Tally tally;
  for (const JudgedPose& pose : judged_poses(a, b, count, random)) {
    const bool ours = collides(a.tree, pose.world_from_a, b.tree, pose.world_from_b);
    ++tally.poses;
    tally.touching += pose.touching;
    tally.missed += pose.touching && !ours;
    if (!ours || pose.touching) continue;
    ++tally.extra;
    const double distance = surface_distance(a.mesh, pose.world_from_a, b.mesh, pose.world_from_b);
    const double slack = collision_slack(a.tree, pose.world_from_a, b.tree, pose.world_from_b) +
                         kFclDistanceError * (a.radius + b.radius);
    const double bound = a.protrusion_bound + b.protrusion_bound + slack;
    tally.worst_excess = std::max(tally.worst_excess, distance - bound);
    tally.worst_share = std::max(tally.worst_share, distance / bound);
    tally.worst_share_of_errors =
        std::max(tally.worst_share_of_errors, distance / (a.max_error + b.max_error + slack));
  }
  return tally;
}

void expect_sound(const FittedModel& a, const FittedModel& b, std::size_t count,
                  std::uint64_t seed) {
  SCOPED_TRACE(a.name + " and " + b.name);
  const Tally tally = compare(a, b, count, seed);
  std::cout << a.name << " (" << a.tree.spheres().size() << " spheres) and " << b.name << " ("
            << b.tree.spheres().size() << "): " << tally.poses << " poses, " << tally.touching
            << " touching, " << tally.missed << " missed, " << tally.extra << " extra, furthest at "
            << tally.worst_share << " of the bound, " << tally.worst_share_of_errors
            << " of E_a + E_b\n";
  EXPECT_EQ(tally.missed, 0u);
  EXPECT_LE(tally.worst_excess, 0.0);
  if (is_convex(a) && is_convex(b)) {
    EXPECT_LE(tally.worst_share_of_errors, 1.0 + kScallops);
  }
  // The poses are worth something only if many lie on each side.
  EXPECT_GT(tally.touching, tally.poses / 10);
  EXPECT_LT(tally.touching, tally.poses * 9 / 10);
}

using Names = std::vector<std::pair<std::string, std::string>>;

// Each list is a test case of its own, so that they run side by side; together 28 pairs. Under
// sanitizers the first of each: nearly all their time goes into the fits.
const std::vector<Names> kShapePairs = {
    {{"cube", "cube"}, {"cube", "sphere"}, {"sphere", "cylinder"}, {"cube", "cone"}},
    {{"slab", "cube"}, {"slab", "cone"}, {"slab", "pipe"}, {"slab", "slab"}},
    {{"torus", "torus"}, {"torus", "cylinder"}, {"torus", "cone"}, {"torus", "bracket"}},
    {{"pipe", "pipe"}, {"pipe", "sphere"}, {"pipe", "bracket"}, {"pipe", "cylinder"}},
    {{"plate", "cylinder"}, {"plate", "bracket"}, {"plate", "cone"}, {"bracket", "bracket"}},
    {{"open-box", "cube"}, {"shells", "cone"}, {"soup", "sphere"}, {"shells", "soup"}},
    {{"torus", "probe"}, {"pipe", "probe"}, {"plate", "probe"}, {"cube", "probe"}}};

class ShapeTruth : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ShapeTruth, NothingMissedAndExtrasAreNear) {
  std::size_t pairs = 0;
  for (const Names& names : kShapePairs) pairs += names.size();
  std::uint64_t seed = 1000 * GetParam();
  for (const auto& [a, b] : effort(kShapePairs[GetParam()], 1)) {
    expect_sound(shape_model(a), shape_model(b), total_poses() / pairs + 1, ++seed);
  }
}

INSTANTIATE_TEST_SUITE_P(, ShapeTruth, ::testing::Range<std::size_t>(0, effort(7, 3)));

struct RealModel {
  std::string file;
  double millimetres;  // of the unit of the file
};

struct RealPair {
  RealModel a, b;
};

const std::string kArm = "robots/abb_irb4400l/meshes/irb4400l_30_243/";
const RealModel kForearm{kArm + "visual/link_4.stl", 1000},
    kWrist{kArm + "visual/link_5.stl", 1000}, kUpperArm{kArm + "visual/link_2.stl", 1000},
    kShoulder{kArm + "collision/link_1.stl", 1000}, kTorch{"torch/torch.stl", 10},
    kPipe{"parts/pipe_id40.stl", 1}, kPipes{"parts/three_pipes.stl", 1},
    kGear{"parts/spur_gear_m2_z24.stl", 1}, kSheet{"parts/bent_sheet_1mm.stl", 1},
    kHousing{"parts/sealed_housing_with_core.stl", 1},
    kFinger{"robots/franka_panda/meshes/collision/finger.obj", 1000},
    kHand{"robots/franka_panda/meshes/collision/hand.obj", 1000},
    kRiser{"parts/idler_riser.STL", 25.4};

std::string pair_name(const RealPair& pair) {
  std::string name = std::filesystem::path(pair.a.file).stem().string() + "_" +
                     std::filesystem::path(pair.b.file).stem().string();
  std::ranges::replace_if(
      name, [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

void PrintTo(const RealPair& pair, std::ostream* out) {
  *out << pair_name(pair);
}

class RealTruth : public ::testing::TestWithParam<RealPair> {};

TEST_P(RealTruth, NothingMissedAndExtrasAreNear) {
  if (!models_dir()) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const auto& [a, b] = GetParam();
  expect_sound(real_model(a.file, a.millimetres), real_model(b.file, b.millimetres),
               total_poses() / 100 + 1, 77);
}

INSTANTIATE_TEST_SUITE_P(, RealTruth,
                         ::testing::Values(RealPair{kForearm, kPipes}, RealPair{kWrist, kTorch},
                                           RealPair{kUpperArm, kShoulder}, RealPair{kTorch, kPipe},
                                           RealPair{kGear, kGear}, RealPair{kSheet, kGear},
                                           RealPair{kHousing, kSheet}, RealPair{kFinger, kHand},
                                           RealPair{kRiser, kPipe}, RealPair{kWrist, kSheet}),
                         [](const auto& tested) { return pair_name(tested.param); });

// The comparison is able to fail: a cover whose spheres are a tenth too small is caught.
TEST(TruthTest, ShrunkSpheresAreCaught) {
  const FittedModel shrunk = fit_model("shrunk", shape_mesh("cube"), 0.05, 0.9);
  EXPECT_GT(compare(shrunk, shape_model("probe"), 10000, 5).missed, 0u);
}

// And so is one whose spheres are a fifth too large.
TEST(TruthTest, GrownSpheresAreCaught) {
  const FittedModel inflated = fit_model("grown", shape_mesh("cube"), 0.05, 1.2);
  const Tally tally = compare(inflated, shape_model("probe"), 2000, 5);
  EXPECT_GT(tally.worst_excess, 0.0);
  EXPECT_GT(tally.worst_share_of_errors, 1.0 + kScallops);
}

// Confirmed hits against FCL on the meshes with their insides: the same verdicts, none missed and
// none extra, down to a micrometre from contact.

constexpr std::size_t kPoses = effort(1200, 100);

CoveredMesh covered(const FittedModel& model) {
  return {model.triangles, std::make_shared<const SphereTree>(model.tree)};
}

void expect_exact(const FittedModel& a, const FittedModel& b, std::uint64_t seed) {
  SCOPED_TRACE(a.name + " and " + b.name);
  const CoveredMesh covered_a = covered(a), covered_b = covered(b);
  Random random(seed);
  std::size_t poses = 0, touching = 0, missed = 0, extra = 0, alarms = 0, unequal = 0;
  for (const JudgedPose& pose : judged_poses(a, b, kPoses, random)) {
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
  for (const auto& [a, b] : effort(pairs, 2)) {
    expect_exact(shape_model(a), shape_model(b), ++seed);
  }
}

TEST(MeshContactTruth, OnRealModels) {
  if (!models_dir()) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const FittedModel& pipes = real_model("parts/three_pipes.stl", 1);
  const FittedModel& gear = real_model("parts/spur_gear_m2_z24.stl", 1);
  expect_exact(real_model(kArm + "visual/link_4.stl", 1000), pipes, 21);
  expect_exact(real_model("torch/torch.stl", 10), pipes, 22);
  expect_exact(gear, gear, 23);
  expect_exact(real_model("parts/sealed_housing_with_core.stl", 1), gear, 24);
}

}  // namespace
}  // namespace spherule::test
