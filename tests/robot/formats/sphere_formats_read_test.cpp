// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/robot/refusals.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

// What is read of files as other programs write them: every number, name and buffer in its place.

namespace spherule::sphere_formats_read_test {
namespace {

using Buffers = std::map<std::string, double>;
using Rational = boost::multiprecision::cpp_rational;

SphereFormatFile read_file(const std::string& text, const SphereReadOptions& options = {}) {
  const test::TempDir folder;
  return read_robot_spheres(folder.write("input", text), options);
}

RobotSpheres read(const std::string& text, const SphereReadOptions& options = {}) {
  return read_file(text, options).spheres;
}

// No coordinate and no radius is like another.
const std::vector<Sphere> kTwo = {{{1, -2, 3}, 0.5}, {{4, 5, -6}, 0.75}};

TEST(ReadSpheres, OfOneMesh) {
  const auto expect_two = [](SphereFormat format, const std::string& text,
                             std::optional<std::size_t> level = {}) {
    const SphereFormatFile file = read_file(text, {.link = "arm", .level = level});
    EXPECT_EQ(file.format, format);
    EXPECT_EQ(difference(file.spheres.links, {{"arm", kTwo}}), "") << text;
    return file.spheres.switched_off;
  };
  const std::string morphit = R"({"centers": [[1, -2, 3], [4, 5, -6]], "radii": [0.5, 0.75])";
  expect_two(SphereFormat::kMorphit, morphit + "}");
  expect_two(SphereFormat::kMorphit, morphit + R"(, "masses": [1, 2], "num_spheres": 2})");
  const std::string foam = R"([{"spheres": [{"origin": [7, 8, 9], "radius": 9}]}, {"spheres": [
    {"origin": [1, -2, 3], "radius": 0.5}, {"origin": [4, 5, -6], "radius": 0.75},
    {"origin": [3, 0, 0], "radius": -1}]}])";
  EXPECT_EQ(expect_two(SphereFormat::kFoam, foam), 1U);
  EXPECT_EQ(read(foam, {.level = 0}).links[0].spheres[0], (Sphere{{7, 8, 9}, 9}));
  expect_two(SphereFormat::kSphereFile, R"({"format": "spherule-spheres", "version": 1, "spheres": [
    {"center": [1, -2, 3], "radius": 0.5}, {"center": [4, 5, -6], "radius": 0.75}]})");
  // Three children to a node, of which one is not used, and a level below.
  const std::string tree =
      "3 3\n0 0 0 9 1\n1 -2 3 0.5 1 0 0 0 0 0\n0 0 0 -1 0\n4 5 -6 0.75 1\n"
      "1 1 1 8 1\n1 1 1 8 1\n1 1 1 8 1\n0 0 0 -1 0\n0 0 0 -1 0\n0 0 0 -1 0\n"
      "1 1 1 8 1\n1 1 1 8 1\n1 1 1 8 1\n";
  EXPECT_EQ(expect_two(SphereFormat::kBradshaw, tree + "Level 1\n", 1), 0U);
  EXPECT_EQ(read(tree).links[0].spheres.size(), 6U);
  EXPECT_EQ(read(tree, {.level = 0}).links[0].spheres[0].radius, 9.0);
  std::string old = tree;
  std::replace(old.begin(), old.end(), '\n', '\r');
  expect_two(SphereFormat::kBradshaw, old, 1);
}

TEST(ReadSpheres, OfOneMeshAreInMetres) {
  const auto in = [](const std::string& units) {
    return R"({"format": "spherule-spheres", "version": 1, "options": {"units": )" + units +
           R"(}, "spheres": [{"center": [0, 0, 0], "radius": 1}]})";
  };
  const auto refusal = [&](const std::string& units) {
    return test::reason_of([&] { read(in(units)); });
  };
  EXPECT_EQ(refusal(R"("m")"), "nothing is wrong");
  EXPECT_TRUE(refusal(R"("mm")").starts_with("has its lengths in 'mm'"));
  EXPECT_TRUE(refusal("7").starts_with("has its lengths in an unknown unit"));
}

TEST(ReadSpheres, ByLinks) {
  const auto expect_two = [](SphereFormat format, const std::string& text) {
    const SphereFormatFile file = read_file(text);
    EXPECT_EQ(file.format, format);
    EXPECT_EQ(difference(file.spheres.links, {{"a", kTwo}, {"b", {}}}), "") << text;
  };
  // A mark of the order of bytes may stand before anything.
  expect_two(SphereFormat::kBallpark,
             "\xef\xbb\xbf"
             R"({"a": {"centers": [[1, -2, 3], [4, 5, -6]], "radii": [0.5, 0.75]},
                 "b": {"centers": [], "radii": []}})");
  expect_two(SphereFormat::kFoam, R"({"a": [{"spheres": [{"origin": [1, -2, 3], "radius": 0.5},
    {"origin": [4, 5, -6], "radius": 0.75}]}], "b": [{"spheres": []}]})");
  const std::string irmv = R"({"a": {"BiggesetSphere": [0, 0, 0, 9],
    "SubSpheres": {"r0": [1, -2, 3, 0.5], "r1": [4, 5, -6, 0.75]}},
    "b": {"BiggesetSphere": [0, 0, 0, 9], "SubSpheres": {}}})";
  expect_two(SphereFormat::kIrmv, irmv);
  EXPECT_EQ(read(irmv, {.level = 0}).links[0].spheres[0].radius, 9.0);
  expect_two(SphereFormat::kUrdf, R"(<robot name="r"><link name="a">
    <collision><origin xyz="1 -2 3" rpy="1 2 3"/><geometry><sphere radius="0.5"/></geometry>
    </collision><collision><origin xyz="4 5 -6"/><geometry><sphere radius="0.75"/></geometry>
    </collision></link><link name="b"/></robot>)");
  expect_two(SphereFormat::kSrdf, R"(<robot name="r"><link_sphere_approximation link="a">
    <sphere center="1 -2 3" radius="0.5"/><sphere center="4 5 -6" radius="0.75"/>
    </link_sphere_approximation><link_sphere_approximation link="b"/></robot>)");
  const std::string yaml =
      "a:\n      - {center: [1, -2, 3], radius: 0.5}\n"
      "      - {center: [4, 5, -6], radius: 0.75}\n      b: []\n";
  expect_two(SphereFormat::kCurobo,
             "robot_cfg:\n  kinematics:\n    collision_spheres:\n      " + yaml);
  expect_two(SphereFormat::kCurobo, "collision_spheres:\n      " + yaml);
  // Collision checks use the geometry that is named, wherever it stands.
  expect_two(SphereFormat::kXrdf,
             "format: xrdf\nformat_version: 1.0\ncollision: {geometry: fine}\ngeometry:\n"
             "  coarse: {spheres: {c: [{center: [0, 0, 0], radius: 9}]}}\n"
             "  fine:\n    spheres:\n      " +
                 yaml);
}

TEST(ReadSpheres, NamesPairsAndBuffers) {
  const RobotSpheres own = read(R"({"format": "spherule-robot-spheres", "version": 1,
    "robot": "r", "links": [{"link": "a", "spheres": [{"center": [1, -2, 3], "radius": 0.5}]}],
    "self_collision_ignore": [{"link1": "a", "link2": "b", "reason": "Never"}],
    "self_collision_buffer": {"a": 0.1}, "collision_buffer": -0.2, "collision_buffers": {"b": 3}})");
  EXPECT_EQ(own.robot, "r");
  ASSERT_EQ(own.self_collision_ignore.size(), 1U);
  EXPECT_EQ(own.self_collision_ignore[0].link_a, "a");
  EXPECT_EQ(own.self_collision_ignore[0].link_b, "b");
  EXPECT_EQ(own.self_collision_ignore[0].reason, "Never");
  EXPECT_EQ(own.self_collision_buffer, (Buffers{{"a", 0.1}}));
  EXPECT_EQ(own.collision_buffer, -0.2);
  EXPECT_EQ(own.collision_buffers, (Buffers{{"b", 3.0}}));

  const RobotSpheres curobo = read(
      "robot: r\ncollision_spheres: {a: []}\nself_collision_ignore: {b: [a, a], a: [b, a, c]}\n"
      "self_collision_buffer: {a: -0.1}\ncollision_sphere_buffer: 0.2\n");
  EXPECT_EQ(curobo.robot, "r");
  ASSERT_EQ(curobo.self_collision_ignore.size(), 2U);  // each once, none with itself
  EXPECT_EQ(curobo.self_collision_buffer, (Buffers{{"a", -0.1}}));
  EXPECT_EQ(curobo.collision_buffer, 0.2);

  const std::string srdf =
      R"(<robot name="r"><disable_collisions link1="a" link2="b" reason="Never"/>
    <link_sphere_approximation link="a"><sphere center="0 0 0" radius="1"/>
    </link_sphere_approximation></robot>)";
  EXPECT_EQ(read(srdf).robot, "r");
  ASSERT_EQ(read(srdf).self_collision_ignore.size(), 1U);
  EXPECT_EQ(read(srdf).self_collision_ignore[0].link_b, "b");
  // What has links is a URDF, whatever else is in it.
  const RobotSpheres urdf =
      read(R"(<robot name="r"><disable_collisions link1="a" link2="b"/><link name="a"><collision>
    <geometry><sphere radius="1"/></geometry></collision></link></robot>)");
  EXPECT_EQ(urdf.robot, "r");
  EXPECT_EQ(urdf.links.size(), 1U);
}

// Links that are named like the spheres of another, but are none.
TEST(ReadSpheres, LinksThatAreNoSpheres) {
  const std::string sphere = "<collision><geometry><sphere radius=\"1\"/></geometry></collision>";
  const auto with_leaf = [](const std::string& leaf, const std::string& type,
                            const std::string& more = "") {
    return read(
        "<robot name=\"r\"><link name=\"a\"><collision><geometry><sphere radius=\"2\"/>"
        "</geometry></collision></link><link name=\"a_sphere1\">" +
        leaf + "</link><joint name=\"j\" type=\"" + type +
        "\"><parent link=\"a\"/>"
        "<child link=\"a_sphere1\"/><origin xyz=\"0 0 5\"/></joint>" +
        more + "</robot>");
  };
  const RobotSpheres is_one = with_leaf(sphere, "fixed");
  ASSERT_EQ(is_one.links.size(), 1U);
  EXPECT_EQ(is_one.links[0].spheres.size(), 2U);
  const std::string child =
      "<link name=\"b\"/><joint name=\"k\" type=\"fixed\"><parent link=\"a_sphere1\"/>"
      "<child link=\"b\"/></joint>";
  for (const RobotSpheres& is_none :
       {with_leaf(sphere, "revolute"), with_leaf(sphere + sphere, "fixed"),
        with_leaf(sphere, "fixed", child),
        with_leaf(sphere + "<visual><geometry><mesh filename=\"m.stl\"/></geometry></visual>",
                  "fixed")}) {
    ASSERT_GE(is_none.links.size(), 2U);
    EXPECT_EQ(is_none.links[0].spheres.size(), 1U);
    EXPECT_EQ(is_none.links[1].link, "a_sphere1");
    EXPECT_EQ(is_none.links[1].spheres.at(0), (Sphere{{0, 0, 0}, 1}));
  }
  const RobotSpheres box =
      with_leaf("<collision><geometry><box size=\"1 1 1\"/></geometry></collision>", "fixed");
  EXPECT_EQ(box.links.size(), 1U);
  EXPECT_EQ(box.other_shapes, 1U);
  // One that is switched off stays so, though a sphere that is moved grows a little.
  const RobotSpheres off = with_leaf(
      "<collision><origin xyz=\"1 0 0\"/><geometry><sphere radius=\"0\"/></geometry></collision>",
      "fixed");
  EXPECT_EQ(off.switched_off, 1U);
  EXPECT_EQ(off.links[0].spheres.size(), 1U);
}

// Only the spheres of the geometry for collisions are read; that another one is meant is told.
TEST(ReadSpheres, AnotherGeometryForSelfCollisions) {
  const auto geometry_for = [](const std::string& self_collision) {
    return read("format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\n" + self_collision +
                "geometry:\n  g: {spheres: {a: []}}\n  own: {spheres: {b: []}}\n")
        .self_collision_geometry;
  };
  EXPECT_EQ(geometry_for(""), "");
  EXPECT_EQ(geometry_for("self_collision: {geometry: g}\n"), "");
  EXPECT_EQ(geometry_for("self_collision: {geometry: own}\n"), "own");
}

TEST(ShrunkByBuffers, TakesTheOwnBufferBeforeTheCommonOne) {
  const Sphere sphere{{1, 2, 3}, 1.0};
  RobotSpheres spheres{
      .links = {{"a", {sphere, {{0, 0, 0}, 0.125}}}, {"b", {sphere}}, {"c", {sphere}}}};
  spheres.collision_buffer = -0.25;
  spheres.collision_buffers = {{"b", -0.5}, {"c", 0.5}};
  const std::vector<LinkSpheres> shrunk = shrunk_by_buffers(spheres);
  // Of a sphere that is smaller than its buffer nothing is left; buffers above zero do not count.
  const double expected[] = {0.75, 0.5, 1.0};
  ASSERT_EQ(shrunk.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(shrunk[i].link, spheres.links[i].link);
    ASSERT_EQ(shrunk[i].spheres.size(), 1U);
    EXPECT_EQ(shrunk[i].spheres[0].center, sphere.center);
    EXPECT_LE(shrunk[i].spheres[0].radius, expected[i]);
    EXPECT_GE(shrunk[i].spheres[0].radius, expected[i] - 1e-15);
  }
}

TEST(ShrunkByBuffers, RoundsDown) {
  test::Random random(14);
  int needed = 0;
  for (int i = 0; i < test::effort(500, 100); ++i) {
    RobotSpheres spheres{.links = {{"a", {{{0, 0, 0}, 1.0 + random.unit()}}}}};
    spheres.collision_buffer = -random.unit();
    const double given = spheres.links[0].spheres[0].radius;
    const Rational exact = Rational(given) + Rational(spheres.collision_buffer);
    const double radius = shrunk_by_buffers(spheres)[0].spheres.at(0).radius;
    EXPECT_LE(Rational(radius), exact);
    EXPECT_GE(radius, (given + spheres.collision_buffer) * (1.0 - 1e-14));
    needed += Rational(given + spheres.collision_buffer) > exact ? 1 : 0;
  }
  EXPECT_GT(needed, 10);
}

}  // namespace
}  // namespace spherule::sphere_formats_read_test

namespace spherule::sphere_formats_models_test {
namespace {

struct Published {
  const char* file;  // below robots
  SphereFormat format;
  std::size_t spheres;
  std::size_t links;  // with spheres
};

constexpr Published kPublished[] = {
    {"franka_panda/peer_spheres/curobo_franka.yml", SphereFormat::kCurobo, 61, 11},
    {"franka_panda/peer_spheres/robometrics_franka_spheres.yml", SphereFormat::kCurobo, 61, 11},
    {"franka_panda/peer_spheres/morphit_franka.yml", SphereFormat::kCurobo, 158, 11},
    {"franka_panda/peer_spheres/vamp_panda_spherized.urdf", SphereFormat::kUrdf, 59, 11},
    {"franka_panda/peer_spheres/foam_smaller_panda_spherized.urdf", SphereFormat::kUrdf, 59, 11},
    {"franka_panda/peer_spheres/cricket_panda_spherized_1.urdf", SphereFormat::kUrdf, 11, 11},
    {"franka_panda/peer_spheres/morphit_panda.spherical.urdf", SphereFormat::kUrdf, 220, 11},
    {"franka_fr3/peer_spheres/cricket_fr3_spherized.urdf", SphereFormat::kUrdf, 55, 11},
};

TEST(PublishedSpheres, AreReadAsTheyAre) {
  const auto models = test::models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS is not set";
  const test::TempDir folder;
  for (const Published& set : kPublished) {
    SCOPED_TRACE(set.file);
    const auto path = *models / "robots" / set.file;
    const SphereFormatFile file = read_robot_spheres(path);
    EXPECT_EQ(file.format, set.format);
    std::size_t spheres = 0;
    std::size_t links = 0;
    for (const LinkSpheres& link : file.spheres.links) {
      spheres += link.spheres.size();
      links += link.spheres.empty() ? 0 : 1;
    }
    EXPECT_EQ(spheres, set.spheres);
    EXPECT_EQ(links, set.links);
    EXPECT_EQ(file.spheres.switched_off, 0u);
    // Written over itself, it holds the same.
    const auto copy = folder.path() / "copy";
    write_robot_spheres(file.spheres, file.format, {.urdf = path, .original = path}, copy);
    EXPECT_EQ(difference(read_robot_spheres(copy).spheres.links, file.spheres.links), "");
  }
}

}  // namespace
}  // namespace spherule::sphere_formats_models_test
