// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/scene_file.h"

#include "base/error.h"
#include "tests/robot/refusals.h"
#include "tests/support/temp_dir.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

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
  static void expect_faults(const std::vector<BadText>& texts) {
    expect_refusals(texts, [](const std::filesystem::path& file) { read_scene(file); });
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
  std::string keys;
  for (int i = 0; i <= 1 << 13; ++i) keys += "\"k" + std::to_string(i) + "\": 0, ";
  expect_faults({
      {"", {"is not JSON"}},
      {"{\n\n 1}",
       {"line 3, column 2: is not JSON: unexpected number literal; expected string literal"}},
      {"[]", {"is not an object"}},
      {"{}", {"is no scene"}},
      {R"({"format": "spherule-spheres", "version": 1})", {"is no scene"}},
      {R"({"format": "spherule-scene"})", {"\"version\" is missing"}},
      {R"({"format": "spherule-scene", "version": 2})", {"\"version\" is not 1"}},
      {R"({"format": "spherule-scene", "version": 1.0})", {"is not a whole number"}},
      {scene(R"("obstacle": [])"), {"the key 'obstacle' is not known here"}},
      {scene(R"("obstacles": [], "obstacles": [])"), {"\"obstacles\" appears twice"}},
      {scene(R"("obstacles": {})"), {"\"obstacles\" is not a list"}},
      {scene(R"("robot": {)" + keys + R"("k": 0})"), {"too many keys"}},
  });
  EXPECT_THROW(read_scene(folder_.path() / "none.json"), Error);
}

TEST_F(SceneFileTest, RefusesFaultyObstacles) {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {R"("pose": {})", "obstacle 0 'table': has no shape: one of mesh"},
      {R"("half_space": {}, "ball": {"radius": 1})", "has both"},
      {R"("ball": {"radius": -1})", "'table': \"ball\": the radius"},
      {R"("ball": {"radius": 1e16})", "is beyond 1e15"},
      {R"("ball": {"radius": "1"})", "is not a number"},
      {R"("ball": {"radius": 1, "length": 2})", "the key 'length'"},
      {R"("ball": {})", "\"radius\" is missing"},
      {R"("box": {"size": [1, 2]})", "is not a list of 3 numbers"},
      {R"("box": {"size": [1, 2, 3, 4]})", "is not a list of 3 numbers"},
      {R"("box": {"size": [1, 2, 0]})", "a size of the box"},
      {R"("mesh": "part.stl")", "\"mesh\" is not an object"},
      {R"("mesh": {"file": 1})", "\"file\" is not a text"},
      {R"("mesh": {"file": ""})", "\"file\" is empty"},
      {R"("mesh": {"file": "a.stl", "scale": 0})", "\"scale\" is 0"},
      {R"("mesh": {"file": "a", "scale": [1, 0, 1]})", "\"scale\" is 0"},
      {R"("mesh": {"file": "a", "scale": [1, 1]})", "is not a list of 3"},
      {R"("points": {"file": "a.ply"})", "\"radius\" is missing"},
      {R"("points": {"file": "a.ply", "radius": 0})", "is not above 0"},
      {R"("points": {"file": "a", "radius": 1, "voxel": -1})", "\"voxel\" is below 0"},
      {R"("points": {"file": "a", "radius": 1, "scale": 0})", "\"scale\" is not above 0"},
      {R"("half_space": {}, "pose": {"position": [0, 0, 1e400]})", "1e400"},
      {R"("half_space": {}, "pose": {"xyz": [0, 0, 1]})", "the key 'xyz'"},
      {R"("half_space": {}, "pose": {"quaternion": [0, 0, 1]})", "is not a list of 4 numbers"},
      {R"("half_space": {}, "pose": {"quaternion": [0, 0, 0, 0]})", "is zero"},
      {R"("half_space": {}, "pose": {"quaternion": [0,0,0,1], "rpy": [0,0,0]})",
       "has both 'quaternion' and 'rpy'"},
  };
  for (const auto& [keys, part] : faults) expect_faults({{obstacle(keys), {part}}});
}

TEST_F(SceneFileTest, RefusesFaultyLists) {
  const std::string region = R"({"body": "a", "name": "tip", "ball": {"center": [0, 0, 0], )";
  const std::vector<std::pair<std::string, std::string>> faults = {
      {R"("obstacles": [{"ball": {"radius": 1}}])", "obstacle 0: \"name\""},
      {R"("obstacles": [{"name": "", "ball": {"radius": 1}}])", "is empty"},
      {R"("obstacles": [{"name": "a", "half_space": {}}, {"name": "a", "half_space": {}}])",
       "obstacle 1: the name 'a' is there twice"},
      {R"("obstacles": [{"name": "a", "half_space": {}}],
          "attached": [{"name": "a", "link": "b", "tree": {"file": "c"}}])",
       "attached object 0: the name 'a' is there twice"},
      {R"("attached": [{"name": "a", "tree": {"file": "c"}}])",
       "attached object 0 'a': \"link\" is missing"},
      {R"("attached": [{"name": "a", "link": "b", "box": {"size": [1, 1, 1]}}])",
       "the key 'box' is not known here"},
      {R"("attached": [{"name": "a", "link": "b", "tree": {"file": "c"}, "max_error": 1}])",
       "is for meshes"},
      {R"("attached": [{"name": "a", "link": "b", "mesh": {"file": "c"}, "max_error": 0}])",
       "\"max_error\" is not above 0"},
      {R"("regions": [{"body": "a", "name": "tip", "ball": {"radius": 1}}])",
       "\"center\" is missing"},
      {R"("regions": [)" + region + R"("radius": 0}}])", "\"radius\" is not above 0"},
      {R"("regions": [)" + region + R"("radius": 1}}, )" + region + R"("radius": 2}}])",
       "the region 'tip' of 'a' is there twice"},
      {R"("allowed_contacts": [{"body": "a", "region": "tip", "other": "b"}])",
       "'a' has no region 'tip'"},
      {R"("allowed_contacts": [{"body": "a"}])", "\"other\" is missing"},
      {R"("padding": [{"body": "a", "distance": -1}])", "is below 0"},
      {R"("padding": [{"body": "a", "other": "b", "distance": 1},
                      {"body": "b", "other": "a", "distance": 0}])",
       "the padding of 'b' is given twice"},
      {R"("robot": {"urdf": "a"})", "\"robot\": the key 'urdf'"},
  };
  for (const auto& [keys, part] : faults) expect_faults({{scene(keys), {part}}});
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
    expect_faults({{obstacle(object), {"the key 'odd' is not known here"}}});
  }
  for (const std::string list :
       {R"("attached": [{"name": "a", "link": "b", "tree": {"file": "c"}, "odd": 1}])",
        R"("regions": [{"body": "a", "name": "b", "ball": {"center": [0, 0, 0], "radius": 1},
                        "odd": 1}])",
        R"("regions": [{"body": "a", "name": "b", "ball": {"center": [0, 0, 0], "radius": 1,
                        "odd": 1}}])",
        R"("allowed_contacts": [{"body": "a", "other": "b", "odd": 1}])",
        R"("padding": [{"body": "a", "distance": 1, "odd": 1}])", R"("robot": {"odd": 1})"}) {
    expect_faults({{scene(list), {"the key 'odd' is not known here"}}});
  }
}

class PointCloudFileTest : public testing::Test {
 protected:
  PointCloudFile read(const std::string& name, std::string_view bytes, double scale = 1.0) const {
    return read_point_cloud(folder_.write(name, bytes), scale);
  }
  std::string fault(const std::string& name, std::string_view bytes, double scale = 1.0) const {
    return reason_of([&] { read(name, bytes, scale); });
  }

  const TempDir folder_;
};

template <class Value>
void append(std::string& bytes, Value value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian == (std::endian::native == std::endian::little))
    std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

const std::vector<Vector3d> kPoints = {{1.0, 2.0, 3.0}, {-0.5, 0.25, 1e6}};

TEST_F(PointCloudFileTest, Text) {
  const PointCloudFile cloud = read("scan.XYZ", "# x y z\n1 2 3 255 0 0\n-0.5,0.25,1e6\n");
  EXPECT_EQ(cloud.points, kPoints);
  EXPECT_GE(cloud.point_error, 1e6 * 0x1p-53);
  EXPECT_LE(cloud.point_error, 1e6 * 0x1p-50);
}

// A lone CR ends a line, as it does where old programs wrote the file; CR LF is one end.
TEST_F(PointCloudFileTest, LinesEndWithEitherCharacterOrBoth) {
  const std::vector<Vector3d> points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    EXPECT_EQ(read("scan.xyz", "# x y z" + end + "1 2 3" + end + "4 5 6" + end + "7 8 9").points,
              points);
    EXPECT_EQ(fault("scan.xyz", "1 2 3" + end + end + "4 5 6 # a" + end + "7 8" + end),
              "line 4: has no x, y and z");
    EXPECT_EQ(fault("scan.ply", "ply" + end + "format ascii 2.0" + end + "end_header" + end),
              "line 2: '2.0' is not version 1.0 of the format");
  }
  EXPECT_EQ(read("scan.xyz", "1 2 3\r4 5 6\n7 8 9\r\n").points, points);
}

TEST_F(PointCloudFileTest, CommasThatMayBeOfDecimalsAreRefused) {
  const std::string reason =
      "has commas beside other separators; numbers are separated by commas, by semicolons or by "
      "blanks, and their decimals are after a point";
  for (const std::string line : {"0,300;0,010;0,020", "0,300 0,010 0,020", "0,300\t0,010\t0,020",
                                 "0,3 ; 0,1 ; 0,2", "1 2,3"}) {
    EXPECT_EQ(fault("scan.csv", "1 2 3\n" + line + "\n"), "line 2: " + reason) << line;
  }
  for (const std::string line : {"1,2,3", "1, 2 ,\t3", "1;2;3", "1 ; 2; 3", "1 2 3 # 4,5;6",
                                 "1 2 3 4,5", "1,2,3,panel of a wall; 7"}) {
    EXPECT_EQ(read("scan.csv", line).points, std::vector{Vector3d(1, 2, 3)}) << line;
  }
}

// As scanners write these files, and no others.
TEST_F(PointCloudFileTest, PtsMayBeginWithTheirNumber) {
  const std::vector<Vector3d> points = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(read("scan.pts", "2\n1 2 3 -1200 9 9 9\n4 5 6 -1200 9 9 9\n").points, points);
  EXPECT_EQ(read("scan.PTS", " 2 \r1 2 3\r4 5 6").points, points);
  EXPECT_EQ(read("scan.pts", "1 2 3\n4 5 6\n").points, points);
  for (const std::string count : {"1", "3", "-2"}) {
    EXPECT_EQ(fault("scan.pts", count + "\n1 2 3\n4 5 6\n"),
              "it says that it has " + count + " points, but it has 2");
  }
  EXPECT_EQ(fault("scan.pts", "2.5\n1 2 3\n"), "line 1: has no x, y and z");
  EXPECT_EQ(fault("scan.pts", "1\n1 2 3\n1\n1 2 3\n"), "line 3: has no x, y and z");
  EXPECT_EQ(fault("scan.xyz", "2\n1 2 3\n4 5 6\n"), "line 1: has no x, y and z");
}

TEST_F(PointCloudFileTest, ScalesAndSaysWhatThatCosts) {
  const PointCloudFile cloud = read("scan.txt", "1 2 3\n", 0.001);
  EXPECT_EQ(cloud.points[0], Vector3d(1.0, 2.0, 3.0) * 0.001);
  EXPECT_GE(cloud.point_error, 0.003 * 0x1p-52);
}

using Integer = boost::multiprecision::cpp_int;
using Rational = boost::multiprecision::cpp_rational;

const Rational kShift = Rational(pow(Integer(10), 40));

// A decimal between a number and the middle to the next one, so that it is read as that number,
// with nearly the largest error.
std::string just_below_the_middle(double number) {
  const Rational next(std::nextafter(number, 2.0 * number));
  const Rational value = number + (next - number) * Rational(499'999, 1'000'000);
  const Rational scaled = value * kShift;
  return Integer(numerator(scaled) / denominator(scaled)).str() + "e-40";
}

Rational exactly(const std::string& decimal) {
  return Rational(Integer(decimal.substr(0, decimal.find('e')))) / kShift;
}

// The bound against exact numbers, where all roundings go the same way.
TEST_F(PointCloudFileTest, TheErrorIsBoundedWhereRoundingsAddUp) {
  double worst_read = 0.0, worst_scaled = 0.0;
  for (int i = 0; i < 20; ++i) {
    // Of (1 + k u') (1 + j u'), where u' = 2 u, the product k j u'^2 is just below u and rounded
    // off.
    const double k = 0x1p25 + 1e6 * i;
    const double j = std::floor(0x1p51 / k);
    const std::string x = just_below_the_middle(1.0 + k * 0x1p-52);
    const std::string factor = just_below_the_middle(1.0 + j * 0x1p-52);
    for (const bool is_scaled : {false, true}) {
      const double scale = is_scaled ? std::stod(factor) : 1.0;
      const PointCloudFile cloud = read("scan.txt", x + " " + x + " " + x + "\n", scale);
      const Rational off =
          exactly(x) * (is_scaled ? exactly(factor) : Rational(1)) - Rational(cloud.points[0].x());
      const Rational error(cloud.point_error);
      ASSERT_LE(Rational(3 * off * off), Rational(error * error)) << i << ' ' << is_scaled;
      double& worst = is_scaled ? worst_scaled : worst_read;
      worst = std::max(worst, Rational(3 * off * off / (error * error)).convert_to<double>());
    }
  }
  EXPECT_GT(worst_read, 0.7);  // of a bound of 3 / 4
  EXPECT_GT(worst_scaled, 0.7);
}

TEST_F(PointCloudFileTest, PlyInText) {
  const PointCloudFile cloud =
      read("a.ply",
           "ply\r\nformat ascii 1.0\ncomment made by hand\nelement camera 1\nproperty float f\n"
           "element vertex 2\nproperty list uchar int seen\nproperty uchar red\n"
           "property double z\nproperty float y\nproperty float x\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "7\n2 5 6 255 3 2 1\n0 0 1e6 0.25 -0.5\n3 0 1 0\n");
  EXPECT_EQ(cloud.points, kPoints);
  EXPECT_GE(cloud.point_error, 1e6 * 0x1p-53);
}

TEST_F(PointCloudFileTest, PlyOfWholeNumbers) {
  for (const bool big_endian : {false, true}) {
    const auto point = [&](const std::string& type, auto x, auto y, auto z) {
      std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                          "_endian 1.0\nelement vertex 1\n";
      for (const char axis : {'x', 'y', 'z'}) bytes += "property " + type + " " + axis + "\n";
      bytes += "end_header\n";
      append(bytes, x, big_endian);
      append(bytes, y, big_endian);
      append(bytes, z, big_endian);
      const PointCloudFile cloud = read("a.ply", bytes);
      EXPECT_EQ(cloud.points, (std::vector{Vector3d(x, y, z)})) << type;
      EXPECT_EQ(cloud.point_error, 0.0);
    };
    using I8 = std::int8_t;
    using U8 = std::uint8_t;
    using I16 = std::int16_t;
    using U16 = std::uint16_t;
    for (const char* type : {"char", "int8"}) point(type, I8{-128}, I8{127}, I8{-1});
    for (const char* type : {"uchar", "uint8"}) point(type, U8{0}, U8{127}, U8{255});
    for (const char* type : {"short", "int16"}) point(type, I16{-32768}, I16{258}, I16{-1});
    for (const char* type : {"ushort", "uint16"}) point(type, U16{1}, U16{258}, U16{65535});
    for (const char* type : {"int", "int32"}) point(type, -2147483647, 66051, -1);
    for (const char* type : {"uint", "uint32"}) point(type, 1u, 66051u, 4294967295u);
  }
}

TEST_F(PointCloudFileTest, PlyInBytes) {
  for (const bool big_endian : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\nelement pose 1\nproperty list uint8 short numbers\n"
                        "element vertex 2\nproperty double x\nproperty float y\nproperty ushort i\n"
                        "property float z\nend_header\n";
    append(bytes, std::uint8_t{2}, big_endian);
    append(bytes, std::int16_t{-3}, big_endian);
    append(bytes, std::int16_t{7}, big_endian);
    for (const Vector3d& point : kPoints) {
      append(bytes, point.x(), big_endian);
      append(bytes, static_cast<float>(point.y()), big_endian);
      append(bytes, std::uint16_t{9}, big_endian);
      append(bytes, static_cast<float>(point.z()), big_endian);
    }
    const PointCloudFile cloud = read("a.ply", bytes);
    EXPECT_EQ(cloud.points, kPoints);
    EXPECT_EQ(cloud.point_error, 0.0);
    // However it is cut short, it is refused.
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_NE(fault("a.ply", bytes.substr(0, length)), "nothing is wrong") << length;
    }
  }
}

// --- as PCL, Open3D and CloudCompare write them ---

TEST_F(PointCloudFileTest, AFirstLineOfNamesSaysWhichColumnsAreRead) {
  const std::string rows = "1,2,3,9\n-0.5,0.25,1e6,9\n";
  EXPECT_EQ(read("a.csv", "x,y,z,intensity\n" + rows).points, kPoints);
  EXPECT_EQ(read("a.csv", "\"X\",\"Y\",\"Z\",\"I\"\r\n" + rows).points, kPoints);
  EXPECT_EQ(read("a.csv", "id;z;r;y;x\n7;3;8;2;1\n7;1e6;8;0.25;-0.5\n").points, kPoints);
  EXPECT_EQ(read("a.txt", "//X Y Z R G B\n1 2 3 9 9 9\n-0.5 0.25 1e6 9 9 9\n").points, kPoints);
  EXPECT_EQ(read("a.asc", "//X Y Z\n2\n1 2 3\n-0.5 0.25 1e6\n").points, kPoints);
  EXPECT_EQ(read("a.asc", "//made by hand\n1 2 3\n-0.5 0.25 1e6\n").points, kPoints);
  EXPECT_EQ(fault("a.asc", "//X Y Z\n3\n1 2 3\n-0.5 0.25 1e6\n"),
            "it says that it has 3 points, but it has 2");
  EXPECT_EQ(fault("a.csv", "a,b,c\n1,2,3\n"),
            "line 1: 'a' is not a number, and the line does not name columns x, y and z");
  EXPECT_EQ(fault("a.csv", "x,y,z,x\n1,2,3,4\n"),
            "line 1: 'x' is not a number, and the line does not name columns x, y and z");
  EXPECT_EQ(fault("a.csv", "n,x,y,z\n1,2,3\n"), "line 2: has no x, y and z");
  EXPECT_EQ(fault("a.csv", "x,y,z\nx,y,z\n"), "line 2: 'x' is not a number");
  EXPECT_EQ(fault("a.csv", "n,x,y,z\n1 2,3 4 5\n"),
            "line 2: has commas beside other separators; numbers are separated by commas, by "
            "semicolons or by blanks, and their decimals are after a point");
}

TEST_F(PointCloudFileTest, WhatIsNotFiniteIsNoPoint) {
  EXPECT_EQ(read("a.xyz", "nan nan nan\n1 2 3\n-nan NaN 0\n-0.5 0.25 1e6\n1 inf 2\n").points,
            kPoints);
  EXPECT_EQ(read("a.xyz", "nan nan nan\n1 2 3\n").points.size(), 1U);
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty float s\nend_header\n";
  EXPECT_EQ(read("a.ply", head + "1 2 3 300 nan\nnan 0 0 -1 0\n-0.5 0.25 1e6 0 inf\n").points,
            kPoints);
}

// A header and its fields as PCL writes them.
std::string pcd_header(const std::string& data, const std::string& points = "2") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS rgb z x _ y normal\n"
         "SIZE 4 8 4 1 2 4\nTYPE U F F U I F\nCOUNT 1 1 1 3 1 2\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 5 6 7 0 1 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

// The fields of points, point by point or field by field.
std::string pcd_data(const std::vector<Vector3d>& points, bool by_field) {
  std::vector<std::string> fields(6);
  std::string all;
  for (const Vector3d& point : points) {
    std::vector<std::string> values(6);
    append(values[0], std::uint32_t{0x7fc00000}, false);
    append(values[1], point.z(), false);
    append(values[2], static_cast<float>(point.x()), false);
    values[3] = "\x01\x02\x03";
    append(values[4], static_cast<std::int16_t>(point.y()), false);
    for (int k = 0; k < 2; ++k) append(values[5], std::nanf(""), false);
    for (std::size_t f = 0; f < 6; ++f) {
      fields[f] += values[f];
      all += values[f];
    }
  }
  if (!by_field) return all;
  all.clear();
  for (const std::string& field : fields) all += field;
  return all;
}

// As LZF without any repetition.
std::string literals(const std::string& data) {
  std::string packed;
  for (std::size_t i = 0; i < data.size(); i += 32) {
    const std::string part = data.substr(i, 32);
    packed += static_cast<char>(part.size() - 1);
    packed += part;
  }
  return packed;
}

std::string with_sizes(const std::string& packed, std::size_t unpacked) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(packed.size()), false);
  append(bytes, static_cast<std::uint32_t>(unpacked), false);
  return bytes + packed;
}

const std::vector<Vector3d> kWhole = {{1.0, -2.0, 3.25}, {-0.5, 300.0, 1e6}};

TEST_F(PointCloudFileTest, PcdInText) {
  const std::string rows =
      "7 3.25 1 0 0 0 -2 nan nan\n\n7 nan 4 0 0 0 4 0 0\n-7 1e6 -.5 0 x 0 300 1 1\n";
  const PointCloudFile cloud = read("a.pcd", pcd_header("ascii", "3") + rows);
  EXPECT_EQ(cloud.points, kWhole);
  EXPECT_GE(cloud.point_error, 1e6 * 0x1p-53);
  EXPECT_EQ(fault("a.pcd", pcd_header("ascii") + rows), "line 15: more data than the header says");
  EXPECT_EQ(fault("a.pcd", pcd_header("ascii", "4") + rows), "line 16: the file is cut short");
  EXPECT_EQ(fault("a.pcd", pcd_header("ascii", "1") + "7 3.25 1 0 0 0 -2 nan\n"),
            "line 12: point 0 has 8 numbers, not 9");
  EXPECT_EQ(fault("a.pcd", pcd_header("ascii", "1") + "7 3.25 one 0 0 0 -2 0 0\n"),
            "line 12: 'one' is not a finite number");
  EXPECT_EQ(fault("a.pcd", pcd_header("ascii", "1") + "7 3.25 1 0 0 0 40000 0 0\n"),
            "line 12: '40000' is not of the type that is stated");
}

TEST_F(PointCloudFileTest, PcdInBytes) {
  const std::string bytes = pcd_header("binary") + pcd_data(kWhole, false);
  const PointCloudFile cloud = read("a.PCD", bytes);
  EXPECT_EQ(cloud.points, kWhole);
  EXPECT_EQ(cloud.point_error, 0.0);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_NE(fault("a.pcd", bytes.substr(0, length)), "nothing is wrong") << length;
  }
  EXPECT_EQ(fault("a.pcd", bytes + "x"), "byte " + std::to_string(pcd_header("binary").size()) +
                                             ": more data than the header says");
  const Vector3d missing(std::nan(""), 0.0, 0.0);
  EXPECT_EQ(
      read("a.pcd", pcd_header("binary", "3") + pcd_data({kWhole[0], missing, kWhole[1]}, false))
          .points,
      kWhole);
}

TEST_F(PointCloudFileTest, PcdOfEveryType) {
  const auto read_one = [&](const std::string& type, const std::string& size, auto value) {
    std::string bytes = "FIELDS x y z\nSIZE " + size + " " + size + " " + size + "\nTYPE " + type +
                        " " + type + " " + type + "\nPOINTS 1\nDATA binary\n";
    for (int k = 0; k < 3; ++k) append(bytes, value, false);
    return read("a.pcd", bytes).points.front();
  };
  EXPECT_EQ(read_one("I", "1", std::int8_t{-128}), Vector3d::Constant(-128));
  EXPECT_EQ(read_one("U", "1", std::uint8_t{255}), Vector3d::Constant(255));
  EXPECT_EQ(read_one("I", "2", std::int16_t{-32768}), Vector3d::Constant(-32768));
  EXPECT_EQ(read_one("U", "2", std::uint16_t{65535}), Vector3d::Constant(65535));
  EXPECT_EQ(read_one("I", "4", std::int32_t{-70000}), Vector3d::Constant(-70000));
  EXPECT_EQ(read_one("U", "4", std::uint32_t{4294967295}), Vector3d::Constant(4294967295));
  EXPECT_EQ(read_one("I", "8", std::int64_t{-5000000000}), Vector3d::Constant(-5e9));
  EXPECT_EQ(read_one("U", "8", std::uint64_t{5000000000}), Vector3d::Constant(5e9));
  EXPECT_EQ(read_one("F", "4", 0.1f), Vector3d::Constant(0.1f));
  EXPECT_EQ(read_one("F", "8", 0.1), Vector3d::Constant(0.1));
}

// Products of what a header says may exceed 64 bits.
TEST_F(PointCloudFileTest, PcdHeadersThatPromiseTooMuch) {
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  for (const char* form : {"binary", "binary_compressed", "ascii"}) {
    const std::string data = std::string("DATA ") + form + "\n";
    const std::string many =
        fault("a.pcd", fields + "WIDTH 1073741824\nHEIGHT 1073741824\n" + data);
    EXPECT_NE(many.find("no usable number of points"), std::string::npos) << many;
    const std::string few = fault("a.pcd", fields + "POINTS 2147483647\n" + data);
    EXPECT_NE(few, "nothing is wrong");
    EXPECT_EQ(few.find("memory"), std::string::npos) << few;
  }
}

TEST_F(PointCloudFileTest, PcdCompressed) {
  const std::string data = pcd_data(kWhole, true);
  const std::string head = pcd_header("binary_compressed");
  const std::string bytes = head + with_sizes(literals(data), data.size());
  EXPECT_EQ(read("a.pcd", bytes).points, kWhole);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_NE(fault("a.pcd", bytes.substr(0, length)), "nothing is wrong") << length;
  }
  const std::string floats =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA binary_compressed\n";
  const auto unpacked = [&](const std::string& packed, std::size_t size = 36) {
    return read("a.pcd", floats + with_sizes(packed, size)).points;
  };
  // One zero, 2 + 7 + 21 more by a long reference to it, 2 + 3 by a short one.
  const std::string zeros = {0, 0, '\xE0', 21, 0, '\x60', 4};
  EXPECT_EQ(unpacked(zeros), std::vector(3, Vector3d(0, 0, 0)));
  // 1.0f, repeated from four bytes before.
  const std::string ones = {3, 0, 0, '\x80', '\x3f', '\xE0', 23, 3};
  EXPECT_EQ(unpacked(ones), std::vector(3, Vector3d(1, 1, 1)));
  const auto refusal = [&](const std::string& packed, std::size_t size = 36) {
    const std::string reason = reason_of([&] { unpacked(packed, size); });
    return reason.substr(std::min(reason.find(": ") + 2, reason.size()));
  };
  EXPECT_EQ(refusal({0, 0, '\xE0', 21, 1, '\x60', 4}),
            "the packed data refer to before their beginning");
  EXPECT_EQ(refusal({0, 0, '\xE0', 22, 0, '\x60', 4}), "the packed data yield more than they say");
  EXPECT_EQ(refusal({0, 0, '\xE0', 20, 0, '\x60', 4}), "the packed data yield less than they say");
  EXPECT_EQ(refusal({0, 0, '\xE0', 21}), "the packed data are cut short");
  EXPECT_EQ(refusal({5, 0, 0}), "the packed data are cut short");
  EXPECT_EQ(refusal(zeros, 35), "the size of the unpacked data is not that of the points");
}

TEST_F(PointCloudFileTest, RefusesPcd) {
  const std::string rest = "POINTS 1\nDATA ascii\n1 2 3\n";
  const auto of_fields = [&](const std::string& fields) { return fault("a.pcd", fields + rest); };
  EXPECT_EQ(of_fields("FIELDS x y\nSIZE 4 4\nTYPE F F\n"),
            "line 5: 'FIELDS' has not one x, one y and one z");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 2 1\n"),
            "line 6: 'FIELDS' has not one x, one y and one z");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n"),
            "line 2: not as many numbers as 'FIELDS' has names");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n"),
            "line 2: '3' is no size of a number: 1, 2, 4 or 8");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 4\nTYPE F F D\n"),
            "line 3: 'D' is no type: F, I or U");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\n"),
            "line 5: a fraction of less than 4 bytes");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 4\n"), "line 4: the header lacks 'TYPE'");
  EXPECT_EQ(of_fields("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nFIELDS x y z\n"),
            "line 4: 'FIELDS' is there twice");
  EXPECT_EQ(of_fields("SHAPE x\n"), "line 1: 'SHAPE' is no entry of a header");
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  EXPECT_EQ(fault("a.pcd", fields), "line 4: the header is cut short: 'DATA' is missing");
  EXPECT_EQ(fault("a.pcd", fields + "DATA ascii\n"), "line 4: the header lacks 'POINTS'");
  EXPECT_EQ(fault("a.pcd", fields + "POINTS 1\nDATA zip\n"),
            "line 5: 'zip' is no form of data: ascii, binary or binary_compressed");
  EXPECT_EQ(fault("a.pcd", fields + "WIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n"),
            "line 7: 'POINTS' is not 'WIDTH' times 'HEIGHT'");
  EXPECT_EQ(fault("a.pcd", fields + "POINTS -1\nDATA ascii\n"),
            "line 4: no usable number of points");
  EXPECT_EQ(fault("a.pcd", fields + "POINTS 2000000000\nDATA ascii\n1 2 3\n"),
            "line 5: the file cannot hold 2000000000 points");
  EXPECT_TRUE(fault("a.pcd", fields + "POINTS 2000000000\nDATA binary\n1234")
                  .ends_with("the file is cut short"));
  EXPECT_TRUE(fault("a.pcd", fields + "POINTS 40000000\nDATA binary_compressed\n" +
                                 with_sizes("abc", 480000000))
                  .ends_with("so few bytes cannot yield what it says"));
  EXPECT_EQ(fault("a.pcd", fields + "POINTS 0\nDATA binary\n"), "it has no points");
}

TEST_F(PointCloudFileTest, Refuses) {
  EXPECT_EQ(fault("a.xyz", "# nothing\n"), "it has no points");
  EXPECT_EQ(fault("a.xyz", "1 2 3\n\n1 2\n"), "line 3: has no x, y and z");
  EXPECT_EQ(fault("a.xyz", "1 2 nan\n"), "it has no points");
  EXPECT_EQ(fault("a.xyz", "1 2 1e999\n"), "line 1: '1e999' is not a number");
  EXPECT_EQ(fault("a.xyz", "1 2 3\n1 2e15 3\n"), "point 1 is beyond 1e15");
  EXPECT_NE(fault("a.stl", "1 2 3\n"), "nothing is wrong");
  EXPECT_NE(fault("a.xyz", "1 2 3\n", 0.0), "nothing is wrong");
  for (const double scale : {1e-310, 2e15}) {
    EXPECT_EQ(fault("a.xyz", "0 0 0\n", scale), "the scale is not a number from 1e-300 to 1e15");
  }
  EXPECT_NE(fault("a.xyz", "1 2 3\n", std::nan("")), "nothing is wrong");
  EXPECT_THROW(read_point_cloud(folder_.path() / "none.ply"), Error);
}

TEST_F(PointCloudFileTest, RefusesPly) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 1\n";
  const std::string axes = "property float x\nproperty float y\n";
  const std::string lacking = "line 6: the vertices lack one of x, y and z";
  EXPECT_EQ(fault("a.ply", head + axes + "end_header\n1 2\n"), lacking);
  EXPECT_EQ(fault("a.ply", head + axes + "property list uchar float z\nend_header\n1 2 1 3\n"),
            "line 7: the vertices lack one of x, y and z");
  EXPECT_EQ(fault("a.ply", head + "end_header\n"),
            "line 4: the element 'vertex' has no properties");
  const std::string whole = head + axes + "property float z\nend_header\n";
  EXPECT_EQ(fault("a.ply", whole + "1 2\n3\n"), "line 8: vertex 0 has too few numbers");
  EXPECT_EQ(fault("a.ply", whole + "1 2 3 4\n"), "line 8: vertex 0 has too many numbers");
  EXPECT_EQ(fault("a.ply", whole + "1 2 3\n4 5 6\n"), "line 9: more data than the header says");
  EXPECT_EQ(fault("a.ply", whole + "1 2 x\n"), "line 8: 'x' is not a finite number");
  const auto header_fault = [&](const std::string& line) {
    return fault("a.ply", head + axes + line + "\nend_header\n");
  };
  EXPECT_EQ(header_fault("property quad x"), "line 6: 'quad' is not a type of number");
  EXPECT_EQ(header_fault("property list quad int z"), "line 6: 'quad' is not a type of number");
  EXPECT_EQ(header_fault("property list float int z"), "line 6: a list of fractional length");
  EXPECT_EQ(header_fault("property int"), "line 6: a property without a name");
  EXPECT_EQ(header_fault("property int z z"), "line 6: 'z' where the line should end");
  EXPECT_EQ(header_fault("property int y"), "line 6: the property 'y' is there twice");
  EXPECT_EQ(header_fault("element vertex 1"), "line 6: the element 'vertex' is there twice");
  EXPECT_EQ(header_fault("element face -1"), "line 6: the file cannot hold -1 items of 'face'");
  EXPECT_EQ(header_fault("element face 1.0"), "line 6: '1.0' is not a whole number");
  EXPECT_EQ(header_fault("format ascii 2.0"), "line 6: '2.0' is not version 1.0 of the format");
  EXPECT_EQ(header_fault("format other 1.0"), "line 6: 'other' is not a PLY format");
  EXPECT_EQ(fault("a.ply", "ply\nproperty int x\nend_header\n"), "line 2: a property of nothing");
  EXPECT_EQ(fault("a.ply", "ply\nelement face 0\nproperty int x\nend_header\n"),
            "line 4: the header names no format");
  EXPECT_EQ(fault("a.ply", "ply\nformat ascii 1.0\nelement face 0\nproperty int x\nend_header\n"),
            "it has no vertices");
  EXPECT_EQ(fault("a.ply", "plx\n"), "line 1: not a PLY file: it does not begin with 'ply'");
}

}  // namespace
}  // namespace spherule::test
