// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "robot/formats/sphere_formats.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/robot/refusals.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <limits>

namespace spherule::sphere_formats_faults_test {
namespace {

namespace fs = std::filesystem;
using test::TempDir;

constexpr SphereFormat kAll[] = {SphereFormat::kUrdf, SphereFormat::kSrdf, SphereFormat::kCurobo,
                                 SphereFormat::kXrdf, SphereFormat::kFoam, SphereFormat::kSpherule};

class SphereFormatFaults : public ::testing::Test {
 protected:
  // Reads a file of this text.
  SphereFormatFile read(const std::string& text, const SphereReadOptions& options = {}) {
    return read_robot_spheres(folder_.write("input", text), options);
  }

  // The reason why it is refused.
  std::string refusal(const std::string& text, const SphereReadOptions& options = {}) {
    return test::reason_of([&] { read(text, options); });
  }

  void expect_refusal(const std::string& text, const std::string& reason) {
    const std::string given = refusal(text);
    EXPECT_NE(given.find(reason), std::string::npos) << "for " << text << "\ngot: " << given;
  }

  TempDir folder_;
};

std::string robot(const std::string& content) {
  return "<robot name=\"r\">\n" + content + "</robot>";
}
std::string collision(const std::string& content) {
  return robot("<link name=\"a\"><collision>" + content + "</collision></link>");
}

TEST_F(SphereFormatFaults, Files) {
  expect_refusal("", "is empty");
  expect_refusal(" \n\t", "is empty");
  EXPECT_THROW(read_robot_spheres(folder_.path() / "missing"), Error);
  EXPECT_THROW(read_robot_spheres(folder_.path()), Error);
  expect_refusal("collision_spheres: gone.yml", "gone.yml: cannot be read");
  expect_refusal("{\"" + std::string(5000, 'n') + "\":[{\"spheres\":[]}]}", "more than 4096 bytes");
}

TEST_F(SphereFormatFaults, Xml) {
  expect_refusal("<robot>", "line 1: is not XML: ");
  expect_refusal("<other/>", "no <robot>");
  expect_refusal("<robot/><robot/>", "more than one root");
  expect_refusal(robot("<link/>"), "line 2: <link>: it has no name");
  expect_refusal(robot("<link name=\"a\"/><link name=\"a\"/>"), "there twice");
  expect_refusal(collision(""), "has no <geometry>");
  expect_refusal(collision("<geometry/>"), "not one shape");
  const auto sphere_of = [](const std::string& radius) {
    return collision("<geometry><sphere " + radius + "/></geometry>");
  };
  expect_refusal(sphere_of(""), "has no radius");
  for (const char* text : {"x", "nan", "inf", "1e999"}) {
    expect_refusal(sphere_of("radius=\"" + std::string(text) + "\""), "is no finite number");
  }
  expect_refusal(sphere_of("radius=\"1 2\""), "numbers where");
  expect_refusal(sphere_of("radius=\"1e16\""), "beyond 1e15");
  expect_refusal(collision("<geometry><sphere radius=\"1\"/><box size=\"1 1 1\"/></geometry>"),
                 "not one shape");
  expect_refusal(collision("<geometry><box size=\"1 1 1\"/></geometry>"), "holds no spheres");
  const std::string sphere = "<geometry><sphere radius=\"1\"/></geometry>";
  expect_refusal(collision(sphere + "<origin xyz=\"1 2\"/>"), "numbers where");
  expect_refusal(collision(sphere + "<origin rpy=\"1 2 z\"/>"), "is no finite number");
  expect_refusal(collision(sphere + "<origin/><origin/>"), "there is one already");
  expect_refusal(collision(sphere) + std::string(1, '\0'), "zero byte");
  const std::string leaf = "<link name=\"a_sphere1\"><collision>" + sphere + "</collision></link>";
  const std::string joint =
      "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"a_sphere1\"/></joint>";
  expect_refusal(robot(leaf + joint), "there is no link \"a\"");
  expect_refusal(robot("<link name=\"a\"/>" + leaf + joint + joint), "is the second joint");
  expect_refusal(robot("<joint name=\"j\" type=\"fixed\"/>"), "has no <parent>");
  expect_refusal(robot("<group name=\"g\"/>"), "has no link_sphere_approximation");
  expect_refusal(robot("<link_sphere_approximation link=\"a\"><sphere center=\"1 2\" radius=\"1\"/>"
                       "</link_sphere_approximation>"),
                 "line 2");
}

TEST_F(SphereFormatFaults, Yaml) {
  const std::string head = "collision_spheres:\n  a:\n";
  expect_refusal("a: [1", "line 1: is not YAML: a '[' before is not closed");
  expect_refusal("a: {b: 1", "is not YAML: a '{' before is not closed");
  expect_refusal("a:\n\tb: 1", "the line is indented by a tab, where YAML takes blanks");
  expect_refusal("a:\n  b: 1\n c: 1",
                 "line 3, column 2: is not YAML: the indentation does not fit");
  expect_refusal("a: b: c", "line 1, column 5: is not YAML: a ':' where no key can stand");
  expect_refusal("a: @b", "line 1, column 4: is not YAML: no value begins so");
  expect_refusal("a: *b", "is not YAML: an alias (*) names no anchor (&) before it");
  expect_refusal("just words", "the file is not a map");
  expect_refusal("a: 1\n---\nb: 2", "exactly one YAML document");
  expect_refusal("a: 1", "has no \"collision_spheres\"");
  expect_refusal("collision_spheres:\n", "has no \"collision_spheres\"");
  expect_refusal(head + "    - {center: [0, 0], radius: 1}", "line 3: \"center\" is not [x, y, z]");
  expect_refusal(head + "    - {center: [0, 0, 0]}", "line 3: \"radius\" is missing");
  expect_refusal(head + "    - {center: [0, 0, 0], radius: x}",
                 "line 3: \"radius\" is not a number");
  expect_refusal(head + "    - {center: [0, 0, 0], radius: \"1\"}", "is not a number");
  expect_refusal(head + "    - {center: [0, 0, .nan], radius: 1}", "a coordinate is not a number");
  expect_refusal(head + "    - {center: [0, 0, 010], radius: 1}",
                 "line 3: a coordinate, 010, is octal to some readers and decimal to others");
  expect_refusal(head + "    - {center: [0, 0, 0], radius: 0o10}", "is not a number");
  expect_refusal(head + "    - {center: [0, 0, 1e17], radius: 1}",
                 "line 3: a number is beyond 1e15");
  expect_refusal(head + "    - {center: [0, 0, 0], radius: 1, radius: 2}", "\"radius\" twice");
  expect_refusal(head + "    - [0, 0, 0, 1]", "line 3: a sphere is not a map");
  expect_refusal(head + "    x: 1", "spheres of a link are not a list");
  expect_refusal(head + "    - {center: [0, 0, 0], radius: 1}\n  a: []", "line 4");
  expect_refusal("x: &x {radius: 1}\n" + head + "    - {<<: *x, center: [0, 0, 0]}", "merge keys");
  EXPECT_THROW(read("collision_spheres: other.yml"), Error);  // a file that is not there
  expect_refusal("robot_cfg: [1]", "robot_cfg is not a map");
  const std::string good = head + "    - {center: [0, 0, 0], radius: 1}\n";
  expect_refusal(good + "collision_link_names: a", "is not a list");
  expect_refusal(good + "self_collision_ignore: {a: b}", "ignored links are not a list");
  expect_refusal(good + "self_collision_buffer: 0.1", "self_collision_buffer is not a map");
  expect_refusal(good + "self_collision_buffer: {a: b}", "a buffer is not a number");
  expect_refusal(good + "collision_sphere_buffer: [1]", "is not a number");
  expect_refusal("format: xrdf", "\"format_version\" is missing");
  expect_refusal("format: xrdf\nformat_version: 2.0", "line 2: is of a version of XRDF");
  expect_refusal("format: xrdf\nformat_version: 1.0", "names no geometry");
  expect_refusal("format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}",
                 "no geometry \"g\"");
  expect_refusal("format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\ngeometry: {g: {}}",
                 "the geometry has no spheres");
  expect_refusal(
      "format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\n"
      "geometry: {g: {spheres: {}}}\nself_collision: {geometry: h}",
      "line 5: has no geometry \"h\"");
}

TEST_F(SphereFormatFaults, Json) {
  const auto own = [](const std::string& more) {
    return R"({"format": "spherule-robot-spheres", "version": )" + more + "}";
  };
  const auto links = [&](const std::string& text) {
    return own(R"(1, "robot": "r", "links": [)" + text + "]");
  };
  const auto foam = [](const std::string& sphere) {
    return R"([{"spheres": [{)" + sphere + "}]}]";
  };
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"{", "is not JSON"},
           {"{}", "no known format"},
           {R"({"a": 1})", "no known format"},
           {R"({"format": "other"})", "unknown format \"other\""},
           {"[]", "has only 0 levels"},
           {"[1]", "is not an object"},
           {foam(R"("origin": [0, 0], "radius": 1)"), "sphere 0: \"origin\" is not [x, y, z]"},
           {foam(R"("origin": [0, 0, 0])"), "\"radius\" is missing"},
           {foam(R"("origin": [0, 0, 1e17], "radius": 1)"), "beyond 1e15"},
           {R"({"centers": [[0, 0, 0]], "radii": []})", "other counts"},
           {R"({"a": {"centers": [[0, 0, "x"]], "radii": [1]}})", "is not a number"},
           {R"({"a": {"BiggesetSphere": [0, 0, 0, 1], "SubSpheres": [1]}})", "not an object"},
           {R"({"a": {"centers": []}, "a": {}})", "the key \"a\" appears twice"},
           {own("0"), "not a positive integer"},
           {own("2"), "has format version 2"},
           {own("1"), "\"robot\" is missing"},
           {links(R"({"link": "a", "spheres": [{"center": [0, 0, 0], "radius": -1}]})"),
            "link \"a\", sphere 0 is negative"},
           {links(R"({"link": "a", "spheres": []}, {"link": "a", "spheres": []})"), "there twice"},
           {R"({"format": "spherule-spheres", "version": 1})", "\"spheres\" is missing"}}) {
    expect_refusal(text, reason);
  }
}

TEST_F(SphereFormatFaults, SphereTrees) {
  expect_refusal("2 2\n0 0 0 1 1\n", "line 3: a node is missing");
  expect_refusal("1 1\n0 0 0 1\n", "line 2: is not \"x y z r occupancy\"");
  expect_refusal("60 60\n0 0 0 1 1\n", "");
  EXPECT_NE(refusal("[{\"spheres\": []}]", {.level = 2}).find("has only 1 levels"),
            std::string::npos);
  EXPECT_NE(refusal("1 1\n0 0 0 1 1\n", {.level = 3}).find("has only 1 levels"), std::string::npos);
}

TEST_F(SphereFormatFaults, CuroboSwitchesSpheresOff) {
  const std::string text =
      "robot_cfg:\n  kinematics:\n    collision_link_names: [a]\n    collision_spheres:\n"
      "      a: [{center: [0, 0, 0], radius: -10}, {center: [0, 0, 0], radius: 0.0}, "
      "{center: [1, 0, 0], radius: 1}]\n      b: [{center: [0, 0, 0], radius: 1}]\n      c:\n";
  const RobotSpheres read_spheres = read(text).spheres;
  EXPECT_EQ(read_spheres.switched_off, 3u);  // b is none of the links that cuRobo examines
  ASSERT_EQ(read_spheres.links.size(), 3u);
  EXPECT_EQ(read_spheres.links[0].spheres.size(), 1u);
  EXPECT_TRUE(read_spheres.links[1].spheres.empty());
  EXPECT_TRUE(read_spheres.links[2].spheres.empty());
}

TEST_F(SphereFormatFaults, CuroboSideFile) {
  fs::create_directory(folder_.path() / "spheres");
  folder_.write("spheres/a.yml", "collision_spheres: {a: [{center: [1, 2, 3], radius: 4}]}");
  const SphereFormatFile file = read(
      "robot_cfg: {kinematics: {collision_spheres: spheres/a.yml, self_collision_ignore: {a: "
      "[b]}}}");
  EXPECT_EQ(file.spheres.links[0].spheres[0], (Sphere{{1, 2, 3}, 4}));
  EXPECT_EQ(file.spheres.self_collision_ignore.size(), 1u);
  folder_.write("spheres/a.yml", "collision_spheres: input");
  EXPECT_THROW(read("collision_spheres: spheres/a.yml"), Error);
}

TEST_F(SphereFormatFaults, Writing) {
  const fs::path urdf = folder_.write("r.urdf", urdf_text({{"a", {}}}));
  const fs::path out = folder_.path() / "out";
  const auto expect_refused = [&](const RobotSpheres& spheres, SphereFormat format) {
    EXPECT_THROW(write_robot_spheres(spheres, format, {.urdf = urdf}, out), Error)
        << name_of(format);
    EXPECT_FALSE(fs::exists(out));
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const SphereFormat format : kAll) {
    expect_refused({}, format);
    expect_refused({.links = {{"", {}}}}, format);
    expect_refused({.links = {{"a", {}}, {"a", {}}}}, format);
    expect_refused({.links = {{"a\x01", {}}}}, format);
    expect_refused({.links = {{"a\n", {}}}}, format);
    expect_refused({.links = {{"\xff", {}}}}, format);
    expect_refused({.links = {{"\xed\xa0\x80", {}}}}, format);
    expect_refused({.links = {{"\xc0\x80", {}}}}, format);
    expect_refused({.links = {{"a", {{{kNan, 0, 0}, 1}}}}}, format);
    expect_refused({.links = {{"a", {{{0, 0, 0}, -1}}}}}, format);
    expect_refused({.links = {{"a", {{{0, 0, 0}, 1e16}}}}}, format);
    expect_refused({.links = {{"a", {}}}, .collision_buffer = kNan}, format);
    if (format != SphereFormat::kSpherule)
      expect_refused({.links = {{"a", {{{0, 0, 0}, 0}}}}}, format);
    const RobotSpheres good{.robot = "r", .links = {{"a", {{{0, 0, 0}, 1}}}}};
    EXPECT_THROW(write_robot_spheres(good, format, {.urdf = urdf}, out / "no" / "folder"), Error);
  }
  expect_refused({.links = {{"b", {{{0, 0, 0}, 1}}}}}, SphereFormat::kUrdf);  // no such link
  expect_refused({.links = {{"a", {{{0, 0, 0}, 1}}}}}, SphereFormat::kMorphit);
  EXPECT_EQ(sphere_file_name("panda", SphereFormat::kCurobo), "panda.curobo.yml");
  EXPECT_EQ(sphere_format_named("json"), SphereFormat::kSpherule);
  EXPECT_FALSE(sphere_format_named("").has_value());
  EXPECT_THROW(sphere_file_name("a/b", SphereFormat::kUrdf), Error);
  EXPECT_THROW(sphere_file_name("", SphereFormat::kUrdf), Error);
  EXPECT_THROW(sphere_file_name("a", SphereFormat::kMorphit), Error);
}

// Whatever is done to a file, it is read or refused with an Error; what is read can be written.
TEST_F(SphereFormatFaults, MutatedFiles) {
  test::Random random(17);
  constexpr std::string_view signs = "<>{}[]\"'&*!|:-#,\n 0e.\x80\xff";
  for (int round = 0; round < test::effort(4, 1); ++round) {
    const RobotSpheres spheres = random_spheres(random, 1 + random.index(5));
    const fs::path urdf = folder_.write("robot.urdf", urdf_text(spheres.links));
    for (const SphereFormat format : kAll) {
      const fs::path seed = folder_.path() / "seed";
      write_robot_spheres(spheres, format, {.urdf = urdf}, seed);
      const std::string good = read_file(seed);
      int refused = 0;
      for (int mutation = 0; mutation < test::effort(40, 15); ++mutation) {
        const std::string bad = test::mutated(good, random, signs);
        try {
          const SphereFormatFile file = read(bad);
          for (const LinkSpheres& link : file.spheres.links) {
            for (const Sphere& sphere : link.spheres)
              EXPECT_TRUE(is_usable(sphere) && sphere.radius >= 0.0);
          }
        } catch (const Error&) {
          ++refused;
        }
      }
      EXPECT_GT(refused, 0) << name_of(format);
    }
  }
}

// Names, too, may be aliases of each other, and tags of one handle copies of it.
TEST_F(SphereFormatFaults, NamesOfAliasesAreCounted) {
  std::string names = "[a0";
  for (int i = 1; i < 1000; ++i) names += ", a" + std::to_string(i);
  std::string text =
      "kinematics:\n  collision_spheres: {a0: []}\n  self_collision_ignore:\n    b: &l " + names +
      "]\n";
  for (int i = 0; i < 1000; ++i) text += "    c" + std::to_string(i) + ": *l\n";
  expect_refusal(text, "aliases make far more names");
  std::string keys = "- &s {center: [0, 0, 0], radius: 1";
  for (int i = 0; i < 1000; ++i) keys += ", k" + std::to_string(i) + ": 0";
  text = "collision_spheres:\n  a:\n  " + keys + "}\n";
  for (int i = 0; i < 1000; ++i) text += "  - *s\n";
  expect_refusal(text, "aliases make far more names");
  expect_refusal("%TAG !e! xyz\n---\ncollision_spheres: {}\n", "%TAG directives");
}

// Some thousand lines of aliases are as many million spheres.
TEST_F(SphereFormatFaults, AliasesThatMultiplySpheresAreRefused) {
  const auto aliases = [](int spheres, int links) {
    std::string text = "s: &s\n";
    for (int i = 0; i < spheres; ++i) text += "  - {center: [0, 0, 0], radius: 1}\n";
    text += "collision_spheres:\n";
    for (int i = 0; i < links; ++i) text += "  l" + std::to_string(i) + ": *s\n";
    return text;
  };
  EXPECT_EQ(read(aliases(20, 10)).spheres.links.size(), 10U);
  expect_refusal(aliases(2000, 2000), "aliases make more spheres than the file has characters");
}

// Found by fuzzing: yaml-cpp finds empty documents without end.
TEST_F(SphereFormatFaults, TokensOutOfPlaceEndTheReading) {
  for (const char* text : {"}", ", 0], radius: 1}\ns: &s\n", "]\n", "{}}\na: 1\n", ": }"}) {
    EXPECT_THROW(read(text), Error) << text;
  }
}

TEST_F(SphereFormatFaults, DeepNesting) {
  for (const char* part : {"[", "{\"a\":", "a: [", "<robot>", "- "}) {
    std::string text;
    for (int depth = 0; depth < 50000; ++depth) text += part;
    EXPECT_NE(refusal(text), "nothing is wrong") << part;
  }
}

}  // namespace
}  // namespace spherule::sphere_formats_faults_test
