// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "collide/collide.h"
#include "collide/meshes/mesh_contact.h"
#include "io/mesh_io.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// A mesh, its spheres, and what is proved about them. Lengths in millimetres.
struct FittedModel {
  std::string name;
  TriangleMesh triangles;
  FclSolid mesh;  // the same
  SphereTree tree;
  Eigen::Vector3d center;   // of its box
  double radius;            // of a sphere about `center` that encloses the mesh
  double max_error;         // E
  double protrusion_bound;  // certified: no sphere reaches further than this from the mesh
};

// Fits the mesh with E of a twentieth of its box diagonal and D of four E.
FittedModel fit_model(const std::string& name, const TriangleMesh& mesh) {
  FclSolid fcl_mesh(mesh);
  const Eigen::AlignedBox3d box = fcl_mesh.box();
  const double error = (test::kSanitized ? 0.1 : 0.05) * box.diagonal().norm();
  SimplifyOptions options;
  options.max_error = error;
  options.min_external_diameter = 4.0 * error;
  options.effort = test::effort(1, 0);
  const Simplification fit = simplify(mesh, options);
  const std::string broken = broken_promises(fit);
  if (!broken.empty()) throw std::runtime_error(name + ": " + broken);
  if (!fit.certificate.protrusion_over_mesh) {
    throw std::runtime_error(name + ": protrusion over the mesh is not known");
  }
  double radius = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    radius = std::max(radius, distance_upper(v, box.center()));
  }
  return {name,
          mesh,
          std::move(fcl_mesh),
          build_tree(fit.cover.spheres),
          box.center(),
          radius,
          error,
          fit.certificate.protrusion_over_mesh->upper};
}

// Made once per process.
const FittedModel& cached(const std::string& name, const std::function<TriangleMesh()>& make) {
  static std::map<std::string, FittedModel> models;
  const auto found = models.find(name);
  if (found != models.end()) return found->second;
  return models.emplace(name, fit_model(name, make())).first->second;
}

// The search ends at this distance from the border. On the way it passes 2 mm and 0.1 mm; each
// halving judges one pose, so that poses at all of these distances are among the results.
constexpr double kNearest = 1e-3;
// Share of the poses that are random without a search.
constexpr double kRandomShare = 0.1;

Pose centered_pose(const FittedModel& model, const Eigen::Quaterniond& rotation,
                   const Eigen::Vector3d& center) {
  return Pose(rotation, center - rotation * model.center);
}

// On a random triangle.
Eigen::Vector3d surface_point(const TriangleMesh& mesh, Random& random) {
  const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  const double s = random.unit(), r = random.unit() * (1.0 - s);
  return corner(0) + s * (corner(1) - corner(0)) + r * (corner(2) - corner(0));
}

// Two placed models and what FCL says of them.
struct JudgedPose {
  Pose world_from_a, world_from_b;
  bool touching = false;
};

class Search {
 public:
  Search(const FittedModel& a, const FittedModel& b, std::vector<JudgedPose>& poses)
      : a_(a), b_(b), poses_(poses) {}

  bool judge(const Pose& world_from_a, const Pose& world_from_b) {
    const bool touching = touch(a_.mesh, world_from_a, b_.mesh, world_from_b);
    poses_.push_back({world_from_a, world_from_b, touching});
    return touching;
  }

  void random_pose(Random& random) {
    const Eigen::Vector3d offset =
        random.direction() * (a_.radius + b_.radius) * random.between(0.0, 1.1);
    judge(centered_pose(a_, random.rotation(), Eigen::Vector3d::Zero()),
          centered_pose(b_, random.rotation(), offset));
  }

  // Sets a point of b's surface on one of a's and halves the way from there to far outside.
  void bisect(Random& random) {
    const Pose world_from_a = centered_pose(a_, random.rotation(), 500.0 * random.direction());
    const Eigen::Quaterniond rotation = random.rotation();
    const Eigen::Vector3d start = world_from_a * surface_point(a_.triangles, random) -
                                  rotation * surface_point(b_.triangles, random);
    const Eigen::Vector3d direction = random.direction();
    const auto at = [&](double s) -> Pose { return Pose(rotation, start + s * direction); };
    double near = 0.0, far = 2.0 * (a_.radius + b_.radius) + 1.0;
    if (!judge(world_from_a, at(near))) return;
    while (far - near > kNearest) {
      const double middle = 0.5 * (near + far);
      (judge(world_from_a, at(middle)) ? near : far) = middle;
    }
  }

 private:
  const FittedModel& a_;
  const FittedModel& b_;
  std::vector<JudgedPose>& poses_;
};

// The plain solids that every run uses, by name.
TriangleMesh shape_mesh(const std::string& name) {
  const std::map<std::string, std::function<TriangleMesh()>> makers = {
      {"cube", [] { return make_cube(100); }},
      // Small enough to find leaks between the spheres of a large model.
      {"probe", [] { return make_cube(0.5); }},
      {"slab",
       [] {
         return make_box({200, 120, 10});
       }},
      {"sphere", [] { return make_sphere(60, 32, 16); }},
      {"torus", [] { return make_torus(80, 20, 48, 24); }},
      {"cylinder", [] { return make_cylinder(30, 160, 48); }},
      {"cone", [] { return make_cone(50, 120, 48); }},
      {"pipe", [] { return make_pipe(40, 34, 150, 48); }},
      {"bracket", [] { return make_l_bracket(100, 60, 12); }},
      {"plate",
       [] {
         return make_plate_with_holes({160, 120, 12}, 3, 2, 30, 24);
       }},
      {"open-box",
       [] { return moved(open_box(), Eigen::Isometry3d(Eigen::Translation3d(-0.5, -0.5, -0.5))); }},
      {"shells", [] { return nested_shells(3); }},
      {"soup", [] { return soup(40, 7); }}};
  TriangleMesh mesh = makers.at(name)();
  if (name == "open-box" || name == "shells" || name == "soup") {
    for (Eigen::Vector3d& v : mesh.vertices) v *= 120.0;  // these are made at unit size
  }
  return mesh;
}

// Fits of those, and of a model below the folder of SPHERULE_MODELS; `millimetres` is the length of
// the unit of its file.
const FittedModel& shape_model(const std::string& name) {
  return cached(name, [&] { return shape_mesh(name); });
}

const FittedModel& real_model(const std::string& file, double millimetres) {
  return cached(file, [&] { return read_mesh(*models_dir() / file, {.scale = millimetres}); });
}

// At least `count` poses of a pair: random ones, and ones that were bisected along random
// directions until the models are within 2 mm, 0.1 mm and 1e-3 mm of the border between touching
// and free, with a pose on each side of the border. Every pose that the search has judged is
// returned. Lengths in millimetres.
std::vector<JudgedPose> judged_poses(const FittedModel& a, const FittedModel& b, std::size_t count,
                                     Random& random) {
  std::vector<JudgedPose> poses;
  Search search(a, b, poses);
  while (static_cast<double>(poses.size()) < kRandomShare * static_cast<double>(count)) {
    search.random_pose(random);
  }
  while (poses.size() < count) search.bisect(random);
  return poses;
}

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

TEST(FclSolid, SeesOneInsideTheOther) {
  const FclSolid big(cube_mesh(10.0)), small(cube_mesh(1.0)), open(open_box());
  const Pose identity, inside = Pose::from_translation({4, 4, 4});
  EXPECT_TRUE(touch(big, identity, small, inside));
  EXPECT_TRUE(touch(small, inside, big, identity));
  EXPECT_TRUE(touch(big, identity, open, inside));
  EXPECT_FALSE(touch(small, Pose::from_translation({-2, 0, 0}), open, identity));
  EXPECT_FALSE(touch(big, identity, small, Pose::from_translation({10.001, 0, 0})));
  // In the wall of a shell, in its sealed hollow and in the core it is not free.
  const FclSolid shells(nested_shells(3)), speck(cube_mesh(1e-3));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.06, 0.06, 0.06})));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.2, 0.2, 0.2})));
  EXPECT_TRUE(touch(shells, identity, speck, Pose::from_translation({0.5, 0.5, 0.5})));
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
