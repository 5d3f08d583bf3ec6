// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/scene_file.h"

#include "base/error.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

class SceneFileTest : public testing::Test {
 protected:
  SceneDescription read(const std::string& text) const {
    return read_scene(folder_.write("cell.json", text));
  }
  // A scene of these keys.
  static std::string scene(const std::string& keys) {
    return R"({"format": "spherule-scene", "version": 1)" + (keys.empty() ? "" : ", " + keys) + "}";
  }
  static std::string obstacle(const std::string& keys) {
    return scene(R"("obstacles": [{"name": "table", )" + keys + "}]");
  }
  std::string fault(const std::string& text) const {
    const std::filesystem::path path = folder_.write("cell.json", text);
    try {
      read_scene(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.subject(), path.string());
      return error.reason();
    }
    return "none";
  }
  void expect_fault(const std::string& text, const std::string& part) const {
    const std::string found = fault(text);
    EXPECT_NE(found.find(part), found.npos) << "of " << text << ": " << found;
  }

  const TempDir folder_;
};

TEST_F(SceneFileTest, Empty) {
  const SceneDescription read_back = read(scene(""));
  EXPECT_TRUE(read_back.obstacles.empty());
  EXPECT_FALSE(read_back.srdf);
}

TEST_F(SceneFileTest, Everything) {
  const SceneDescription read_back = read(scene(R"(
    "robot": {"pose": {"position": [0, 0, 1]}, "srdf": "robot.srdf"},
    "obstacles": [
      {"name": "table", "box": {"size": [1, 2, 0.1]}, "pose": {"position": [0.5, 0, 0]}},
      {"name": "ball", "ball": {"radius": 0.2}},
      {"name": "post", "cylinder": {"radius": 0.1, "length": 2},
       "pose": {"quaternion": [0, 0, 2, 2]}},
      {"name": "hose", "capsule": {"radius": 0.1, "length": 0}},
      {"name": "floor", "half_space": {}, "pose": {"rpy": [0, 0, 1.5]}},
      {"name": "part", "mesh": {"file": "sub/part.stl", "scale": 0.001}},
      {"name": "mirrored", "mesh": {"file": "part.stl", "scale": [1, -1, 1]}},
      {"name": "rack", "spheres": {"file": "rack.spheres.json"}},
      {"name": "cell", "tree": {"file": "cell.tree"}},
      {"name": "scan", "points": {"file": "scan.ply", "radius": 0.01, "voxel": 0.02, "scale": 2}}],
    "attached": [
      {"name": "torch", "link": "tool0", "mesh": {"file": "torch.stl"}, "max_error": 0.002,
       "pose": {"position": [0, 0, 0.1]}},
      {"name": "cable", "link": "link_3", "spheres": {"file": "cable.json"}}],
    "regions": [{"body": "torch", "name": "tip", "ball": {"center": [0, 0, 0.3], "radius": 0.02}}],
    "allowed_contacts": [{"body": "torch", "region": "tip", "other": "part"},
                         {"body": "cable", "other": "link_4"}],
    "padding": [{"body": "torch", "distance": 0.005},
                {"body": "torch", "other": "part", "distance": 0}])"));
  EXPECT_EQ(read_back.world_from_root.translation(), Vector3d(0, 0, 1));
  EXPECT_EQ(read_back.srdf, folder_.path() / "robot.srdf");
  const auto& obstacles = read_back.obstacles;
  ASSERT_EQ(obstacles.size(), 10u);
  const auto primitive = [&](std::size_t i) { return std::get<Primitive>(obstacles[i].shape); };
  EXPECT_EQ(obstacles[0].name, "table");
  EXPECT_EQ(std::get<Box>(primitive(0)).size, Vector3d(1, 2, 0.1));
  EXPECT_EQ(obstacles[0].world_from_shape.translation(), Vector3d(0.5, 0, 0));
  EXPECT_EQ(std::get<SolidSphere>(primitive(1)).radius, 0.2);
  EXPECT_EQ(std::get<Cylinder>(primitive(2)).length, 2.0);
  EXPECT_LT((obstacles[2].world_from_shape * Vector3d(1, 0, 0) - Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_EQ(std::get<Capsule>(primitive(3)).length, 0.0);
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(primitive(4)));
  EXPECT_LT((obstacles[4].world_from_shape * Vector3d(1, 0, 0) -
             Vector3d(std::cos(1.5), std::sin(1.5), 0))
                .norm(),
            1e-15);
  const auto& part = std::get<MeshFile>(obstacles[5].shape);
  EXPECT_EQ(part.path, folder_.path() / "sub/part.stl");
  EXPECT_EQ(part.scale, Vector3d::Constant(0.001));
  EXPECT_EQ(std::get<MeshFile>(obstacles[6].shape).scale, Vector3d(1, -1, 1));
  EXPECT_EQ(std::get<SpheresSource>(obstacles[7].shape).path, folder_.path() / "rack.spheres.json");
  EXPECT_EQ(std::get<TreeSource>(obstacles[8].shape).path, folder_.path() / "cell.tree");
  const auto& scan = std::get<PointsSource>(obstacles[9].shape);
  EXPECT_EQ(scan.path, folder_.path() / "scan.ply");
  EXPECT_EQ(scan.radius, 0.01);
  EXPECT_EQ(scan.voxel, 0.02);
  EXPECT_EQ(scan.scale, 2.0);
  ASSERT_EQ(read_back.attached.size(), 2u);
  EXPECT_EQ(read_back.attached[0].link, "tool0");
  EXPECT_EQ(read_back.attached[0].max_error, 0.002);
  EXPECT_EQ(read_back.attached[0].link_from_object.translation(), Vector3d(0, 0, 0.1));
  EXPECT_TRUE(std::holds_alternative<SpheresSource>(read_back.attached[1].shape));
  ASSERT_EQ(read_back.regions.size(), 1u);
  EXPECT_EQ(read_back.regions[0].around, (Sphere{{0, 0, 0.3}, 0.02}));
  ASSERT_EQ(read_back.allowed_contacts.size(), 2u);
  EXPECT_EQ(read_back.allowed_contacts[0].region, "tip");
  EXPECT_EQ(read_back.allowed_contacts[1].other, "link_4");
  ASSERT_EQ(read_back.padding.size(), 2u);
  EXPECT_EQ(read_back.padding[0].padding, 0.005);
  EXPECT_EQ(read_back.padding[1].other, "part");
}

TEST_F(SceneFileTest, RollPitchYawIsThatOfUrdf) {
  const SceneDescription read_back =
      read(obstacle(R"("half_space": {}, "pose": {"rpy": [0.3, -0.4, 2.0]})"));
  const double r = 0.3, p = -0.4, y = 2.0;
  const Vector3d expected(-std::sin(y) * std::cos(r) + std::cos(y) * std::sin(p) * std::sin(r),
                          std::cos(y) * std::cos(r) + std::sin(y) * std::sin(p) * std::sin(r),
                          std::cos(p) * std::sin(r));
  EXPECT_LT((read_back.obstacles[0].world_from_shape * Vector3d(0, 1, 0) - expected).norm(), 1e-15);
}

TEST_F(SceneFileTest, RefusesOtherFiles) {
  expect_fault("", "is not JSON");
  expect_fault("{\n\n 1}",
               "line 3, column 2: is not JSON: unexpected number literal; expected string literal");
  expect_fault("[]", "is not an object");
  expect_fault("{}", "is no scene");
  expect_fault(R"({"format": "spherule-spheres", "version": 1})", "is no scene");
  expect_fault(R"({"format": "spherule-scene"})", "'version' is missing");
  expect_fault(R"({"format": "spherule-scene", "version": 2})", "version: is not 1");
  expect_fault(scene(R"("obstacle": [])"), "the key 'obstacle' is not known here");
  expect_fault(scene(R"("obstacles": [], "obstacles": [])"), "\"obstacles\" appears twice");
  expect_fault(scene(R"("obstacles": {})"), "obstacles: is not a list");
  std::string keys;
  for (int i = 0; i <= 1 << 13; ++i) keys += "\"k" + std::to_string(i) + "\": 0, ";
  expect_fault(scene(R"("robot": {)" + keys + R"("k": 0})"), "too many keys");
  EXPECT_THROW(read_scene(folder_.path() / "none.json"), Error);
}

TEST_F(SceneFileTest, RefusesFaultyObstacles) {
  expect_fault(scene(R"("obstacles": [{"ball": {"radius": 1}}])"), "obstacle 0: 'name'");
  expect_fault(scene(R"("obstacles": [{"name": "", "ball": {"radius": 1}}])"), "is empty");
  expect_fault(scene(R"("obstacles": [{"name": "a", "half_space": {}},
                                      {"name": "a", "half_space": {}}])"),
               "obstacle 1: the name 'a' is there twice");
  expect_fault(scene(R"("obstacles": [{"name": "a", "half_space": {}}],
                        "attached": [{"name": "a", "link": "b", "tree": {"file": "c"}}])"),
               "attached object 0: the name 'a' is there twice");
  expect_fault(obstacle(R"("pose": {})"), "obstacle 0 'table': has no shape: one of mesh");
  expect_fault(obstacle(R"("half_space": {}, "ball": {"radius": 1})"), "has both");
  expect_fault(obstacle(R"("ball": {"radius": -1})"), "'table', ball: the radius");
  expect_fault(obstacle(R"("ball": {"radius": 1e16})"), "is beyond 1e15");
  expect_fault(obstacle(R"("ball": {"radius": "1"})"), "is not a number");
  expect_fault(obstacle(R"("ball": {"radius": 1, "length": 2})"), "the key 'length'");
  expect_fault(obstacle(R"("ball": {})"), "'radius' is missing");
  expect_fault(obstacle(R"("box": {"size": [1, 2]})"), "is not a list of 3 numbers");
  expect_fault(obstacle(R"("box": {"size": [1, 2, 0]})"), "a size of the box");
  expect_fault(obstacle(R"("mesh": "part.stl")"), "mesh: is not an object");
  expect_fault(obstacle(R"("mesh": {"file": "a.stl", "scale": 0})"), "scale: is 0");
  expect_fault(obstacle(R"("points": {"file": "a.ply"})"), "'radius' is missing");
  expect_fault(obstacle(R"("points": {"file": "a.ply", "radius": 0})"), "is not above 0");
  expect_fault(obstacle(R"("half_space": {}, "pose": {"position": [0, 0, 1e400]})"), "1e400");
  expect_fault(obstacle(R"("half_space": {}, "pose": {"xyz": [0, 0, 1]})"), "the key 'xyz'");
  expect_fault(obstacle(R"("half_space": {}, "pose": {"quaternion": [0, 0, 0, 0]})"), "is zero");
  expect_fault(obstacle(R"("half_space": {}, "pose": {"quaternion": [0,0,0,1], "rpy": [0,0,0]})"),
               "has both 'quaternion' and 'rpy'");
}

TEST_F(SceneFileTest, RefusesFaultyRest) {
  expect_fault(scene(R"("attached": [{"name": "a", "tree": {"file": "c"}}])"),
               "attached object 0 'a': 'link' is missing");
  expect_fault(scene(R"("attached": [{"name": "a", "link": "b", "box": {"size": [1, 1, 1]}}])"),
               "the key 'box' is not known here");
  expect_fault(scene(R"("attached": [{"name": "a", "link": "b", "tree": {"file": "c"},
                                      "max_error": 1}])"),
               "is for meshes");
  expect_fault(scene(R"("regions": [{"body": "a", "name": "tip", "ball": {"radius": 1}}])"),
               "'center' is missing");
  expect_fault(scene(R"("allowed_contacts": [{"body": "a", "region": "tip", "other": "b"}])"),
               "'a' has no region 'tip'");
  expect_fault(scene(R"("allowed_contacts": [{"body": "a"}])"), "'other' is missing");
  expect_fault(scene(R"("padding": [{"body": "a", "distance": -1}])"), "is below 0");
  expect_fault(scene(R"("padding": [{"body": "a", "other": "b", "distance": 1},
                                     {"body": "b", "other": "a", "distance": 0}])"),
               "the padding of 'b' is given twice");
  expect_fault(scene(R"("robot": {"urdf": "a"})"), "robot: the key 'urdf'");
}

// A misspelt word must not place an obstacle elsewhere than it was meant.
TEST_F(SceneFileTest, RefusesUnknownKeysAtEveryPlace) {
  for (const std::string object :
       {R"("mesh": {"file": "a.stl", "odd": 1})",
        R"("points": {"file": "a", "radius": 1, "odd": 1})",
        R"("box": {"size": [1, 1, 1], "odd": 1})", R"("half_space": {"odd": 1})",
        R"("cylinder": {"radius": 1, "length": 1, "odd": 1})", R"("tree": {"file": "a", "odd": 1})",
        R"("capsule": {"radius": 1, "length": 1, "odd": 1})", R"("half_space": {}, "odd": 1)",
        R"("spheres": {"file": "a", "odd": 1})", R"("half_space": {}, "pose": {"odd": 1})"}) {
    expect_fault(obstacle(object), "the key 'odd' is not known here");
  }
  for (const std::string list :
       {R"("attached": [{"name": "a", "link": "b", "tree": {"file": "c"}, "odd": 1}])",
        R"("regions": [{"body": "a", "name": "b", "ball": {"center": [0, 0, 0], "radius": 1},
                        "odd": 1}])",
        R"("regions": [{"body": "a", "name": "b", "ball": {"center": [0, 0, 0], "radius": 1,
                        "odd": 1}}])",
        R"("allowed_contacts": [{"body": "a", "other": "b", "odd": 1}])",
        R"("padding": [{"body": "a", "distance": 1, "odd": 1}])", R"("robot": {"odd": 1})"}) {
    expect_fault(scene(list), "the key 'odd' is not known here");
  }
}

TEST_F(SceneFileTest, RefusesFaultyValues) {
  expect_fault(obstacle(R"("points": {"file": "a", "radius": 1, "voxel": -1})"),
               "voxel: is below 0");
  expect_fault(obstacle(R"("points": {"file": "a", "radius": 1, "scale": 0})"),
               "scale: is not above 0");
  expect_fault(obstacle(R"("mesh": {"file": "a", "scale": [1, 0, 1]})"), "scale: is 0");
  expect_fault(obstacle(R"("mesh": {"file": "a", "scale": [1, 1]})"), "is not a list of 3");
  expect_fault(obstacle(R"("mesh": {"file": 1})"), "file: is not a text");
  expect_fault(obstacle(R"("mesh": {"file": ""})"), "file: is empty");
  expect_fault(obstacle(R"("box": {"size": [1, 2, 3, 4]})"), "is not a list of 3 numbers");
  expect_fault(obstacle(R"("half_space": {}, "pose": {"quaternion": [0, 0, 1]})"),
               "is not a list of 4 numbers");
  expect_fault(R"({"format": "spherule-scene", "version": 1.0})", "is not a whole number");
  const std::string region = R"({"body": "a", "name": "tip", "ball": {"center": [0, 0, 0], )";
  expect_fault(scene(R"("regions": [)" + region + R"("radius": 0}}])"), "radius: is not above 0");
  expect_fault(
      scene(R"("regions": [)" + region + R"("radius": 1}}, )" + region + R"("radius": 2}}])"),
      "the region 'tip' of 'a' is there twice");
  expect_fault(scene(R"("attached": [{"name": "a", "link": "b", "mesh": {"file": "c"},
                                      "max_error": 0}])"),
               "max_error: is not above 0");
}

}  // namespace
}  // namespace spherule::test
