// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/scene_setup.h"

#include "base/error.h"
#include "io/mesh_io.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/refusals.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

namespace spherule::test::scene_setup_test {
namespace {

using Rational = boost::multiprecision::cpp_rational;

// Whether a sphere contains the one of the radius about (x, y, z), in exact arithmetic.
bool contains(const Sphere& sphere, const Rational (&point)[3], double radius) {
  const Rational room = Rational(sphere.radius) - Rational(radius);
  Rational squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Rational off = point[axis] - Rational(sphere.center[axis]);
    squared += off * off;
  }
  return room >= 0 && squared <= room * room;
}

MeshFile write_mesh(const TempDir& folder, const TriangleMesh& mesh) {
  write_stl(mesh, folder.path() / "mesh.stl");
  return {.path = folder.path() / "mesh.stl"};
}

// Two cubes with a gap of 0.2 between them, in which a pin stands: D of the robot fills the gap, D
// of the object does not. What is said of links is not meant for it.
TEST(PrepareScene, AttachedMeshesHaveTheirOwnErrorAndD) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TempDir folder;
  const TriangleMesh fork = joined(box_mesh({-0.2, -0.05, -0.05}, {-0.1, 0.05, 0.05}),
                                   box_mesh({0.1, -0.05, -0.05}, {0.2, 0.05, 0.05}));
  RobotModel robot("base");
  robot.add_link("hand", "base",
                 {.name = "slide", .type = JointType::kPrismatic, .lower = -1.0, .upper = 1.0});
  SceneDescription scene;
  scene.obstacles.push_back({.name = "pin", .shape = Primitive(SolidSphere{.radius = 0.01})});
  scene.attached.push_back({.name = "fork", .link = "hand", .shape = write_mesh(folder, fork)});
  const RobotCoverOptions cover{.max_error = 0.05,
                                .min_external_diameter = 1.0,
                                .links = {{"hand", {.max_error = 0.01}}},
                                .effort = 0};
  const auto is_free = [&] {
    return Checked(prepare_scene(robot, scene, cover).scene).free(Configuration{0.0});
  };
  EXPECT_FALSE(is_free());
  scene.attached.front().max_error = 0.03;
  EXPECT_TRUE(is_free());
}

TEST(PrepareScene, SpheresInAnotherUnitAreRefused) {
  const TempDir folder;
  const auto obstacle = [&](const std::string& units) {
    SceneDescription scene;
    scene.obstacles.push_back(
        {.name = "part",
         .shape = SpheresSource{folder.write(
             "part.json",
             "{\"format\": \"spherule-spheres\", \"version\": 1, \"options\": {\"units\": \"" +
                 units + "\"}, \"spheres\": [{\"center\": [0, 0, 0], \"radius\": 1}]}")}});
    return scene;
  };
  EXPECT_NO_THROW(prepare_scene(RobotModel("base"), obstacle("m"), {}));
  EXPECT_THROW(prepare_scene(RobotModel("base"), obstacle("mm"), {}), Error);
}

TEST(PrepareScene, SharesWhatIsNamedAgain) {
  const TempDir folder;
  const MeshFile box = write_mesh(folder, cube_mesh());
  const MeshFile stretched{.path = box.path, .scale = {2.0, 1.0, 1.0}};
  const PointsSource scan{.path = folder.write("scan.xyz", "1 1 1\n"), .radius = 0.01};
  PointsSource thicker = scan;
  thicker.radius = 0.02;
  SceneDescription scene;
  const auto add = [&](const char* name, const auto& shape) {
    scene.obstacles.push_back({.name = name, .shape = shape});
  };
  add("box", box);
  add("again", box);
  add("stretched", stretched);
  add("scan", scan);
  add("rescan", scan);
  add("thicker", thicker);
  const RobotScene made = prepare_scene(RobotModel("base"), scene, {}).scene;
  const auto solid = [&](const char* name) {
    return std::get<std::shared_ptr<const SolidMesh>>(made.obstacle(name).shape);
  };
  EXPECT_EQ(solid("box"), solid("again"));
  EXPECT_NE(solid("box"), solid("stretched"));
  const auto tree = [&](const char* name) {
    return std::get<std::shared_ptr<const SphereTree>>(made.obstacle(name).shape);
  };
  EXPECT_EQ(tree("scan"), tree("rescan"));
  EXPECT_NE(tree("scan"), tree("thicker"));
}

TEST(PrepareScene, RefusesALargeShapeInManyPlaces) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TempDir folder;
  std::string points;
  for (int i = 0; i < 20'000; ++i) points += std::to_string(i) + " 0 0\n";
  const PointsSource cloud{.path = folder.write("scan.xyz", points), .radius = 0.01};
  SceneDescription scene;
  for (int i = 0; i < 100; ++i) {
    scene.obstacles.push_back({.name = std::to_string(i), .shape = cloud});
  }
  EXPECT_EQ(prepare_scene(RobotModel("base"), scene, {}).scene.obstacles().size(), 100U);
  // The rest is read with a radius of its own each.
  for (int i = 100; i < 300; ++i) {
    PointsSource other = cloud;
    other.radius = 0.01 + i;
    scene.obstacles.push_back({.name = std::to_string(i), .shape = other});
  }
  const std::string reason = reason_of([&] { prepare_scene(RobotModel("base"), scene, {}); });
  EXPECT_NE(reason.find("that the scene repeats"), std::string::npos) << reason;
}

// Decimals are rounded when they are read and again when they are scaled: by less than one part in
// 10^15, but a sphere that does not grow by it is too small.
TEST(PointSpheres, ContainThoseAboutThePointsAsWritten) {
  const TempDir folder;
  constexpr double kRadius = 0.01;
  int needed = 0;
  for (const int scale : {1, 1000}) {
    for (int i = 1; i <= 40; ++i) {
      // A tenth of i, 7 i and -3 i, divided by the scale.
      std::ostringstream line;
      Rational point[3];
      for (int axis = 0; axis < 3; ++axis) {
        const int tenths = i * (axis == 0 ? 1 : axis == 1 ? 7 : -3);
        line << (tenths < 0 ? "-" : "") << std::abs(tenths) / 10 << '.' << std::abs(tenths) % 10
             << ' ';
        point[axis] = Rational(tenths, 10 * scale);
      }
      const PointsSource source{
          .path = folder.write("scan.xyz", line.str()), .radius = kRadius, .scale = 1.0 / scale};
      const std::vector<Sphere> spheres = point_spheres(source);
      ASSERT_EQ(spheres.size(), 1U);
      EXPECT_TRUE(contains(spheres[0], point, kRadius)) << i << ' ' << scale;
      EXPECT_LE(spheres[0].radius, kRadius + 1e-13);
      needed += contains({spheres[0].center, kRadius}, point, kRadius) ? 0 : 1;
    }
  }
  EXPECT_GT(needed, 60);
}

TEST(PointSpheres, OneForThoseOfACell) {
  const TempDir folder;
  PointsSource source{.path = folder.write("scan.xyz", "1 1 1\n2 1 1\n9 1 1\n"), .radius = 0.01};
  EXPECT_EQ(point_spheres(source).size(), 3U);
  source.scale = 0.001;
  source.voxel = 0.005;
  EXPECT_EQ(point_spheres(source).size(), 2U);
}

}  // namespace
}  // namespace spherule::test::scene_setup_test
