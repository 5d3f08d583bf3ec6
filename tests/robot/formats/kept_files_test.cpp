// SPDX-License-Identifier: BSD-3-Clause
// Existing files that get other spheres and the pairs that they do not ignore yet: everything else
// stays as data, in its order. The texts are styled as the published files are.
#include "base/files.h"
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "tests/robot/refusals.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

class KeptFiles : public ::testing::Test {
 protected:
  // What is written for an original; written once more, the result stays as it is.
  std::string written(SphereFormat format, const std::string& original) {
    const auto write = [&](const std::string& text) {
      write_robot_spheres(spheres_, format, {.original = folder_.write("original", text)}, out_);
      return read_file(out_);
    };
    std::string text = write(original);
    EXPECT_EQ(write(text), text) << "the second time";
    return text;
  }

  // And all spheres and pairs can be read.
  std::string kept(SphereFormat format, const std::string& original) {
    const std::string text = written(format, original);
    const RobotSpheres read = read_robot_spheres(out_).spheres;
    std::set<std::pair<std::string, std::string>> pairs;
    for (const DisabledPair& pair : read.self_collision_ignore) {
      EXPECT_TRUE(pairs.insert(std::minmax(pair.link_a, pair.link_b)).second);
    }
    for (const DisabledPair& pair : spheres_.self_collision_ignore) {
      EXPECT_TRUE(pairs.contains(std::minmax(pair.link_a, pair.link_b))) << text;
    }
    EXPECT_EQ(read.links.size(), spheres_.links.size());
    for (std::size_t i = 0; i < std::min(read.links.size(), spheres_.links.size()); ++i) {
      EXPECT_EQ(read.links[i].link, spheres_.links[i].link);
      EXPECT_EQ(read.links[i].spheres, spheres_.links[i].spheres);
    }
    return text;
  }

  void expect_refusal(SphereFormat format, const std::string& original, const std::string& reason) {
    const std::string found = test::message_of([&] {
      write_robot_spheres(spheres_, format, {.original = folder_.write("original", original)},
                          out_);
    });
    EXPECT_NE(found.find(reason), std::string::npos) << found;
    EXPECT_FALSE(std::filesystem::exists(out_));
  }

  test::TempDir folder_;
  std::filesystem::path out_ = folder_.path() / "kept";
  RobotSpheres spheres_{
      .robot = "arm",
      .links = {{"base", {{{0, 0, 0}, 0.5}}}, {"arm", {{{1, 2, 3}, 0.25}}}, {"hand", {}}},
      .self_collision_ignore = {
          {"base", "arm", "Adjacent"}, {"hand", "base", "Never"}, {"arm", "hand", {}}}};
};

// As they stand below a key in column 4.
const std::string kSpheres = R"(
      base:
        - {center: [0.0, 0.0, 0.0], radius: 0.5}
      arm:
        - {center: [1.0, 2.0, 3.0], radius: 0.25}
      hand: []
)";

const std::string kXrdf =
    "format: xrdf\nformat_version: 1.0\ncollision:\n  geometry: auto\ngeometry:\n  auto:\n"
    "    spheres:";

// Comments and layout go; every key, its order and the type of every value stay.
TEST_F(KeptFiles, CuroboInBraces) {
  EXPECT_EQ(
      kept(SphereFormat::kCurobo, R"(##
## Somebody's notice
robot_cfg:
  kinematics:
    use_usd_kinematics: False
    urdf_path: "robot/arm.urdf"  # relative
    collision_link_names:
      [
        "base", # first
        "hand",
      ]
    collision_spheres:
      "base":
        - "center": [9, 9, 9]
          "radius": 9.0
    self_collision_ignore:
      {
        "base": ["arm", "other"],
        "other": ["tool"],
      }
    lock_joints: {"a": 0.04, 'b': !!float 4e-2}
)"),
      R"(robot_cfg:
  kinematics:
    use_usd_kinematics: False
    urdf_path: "robot/arm.urdf"
    collision_link_names: ["base", "hand", arm]
    collision_spheres:)" +
          kSpheres +
          R"(    self_collision_ignore: {"base": ["arm", "other", hand], "other": ["tool"], hand: [arm]}
    lock_joints: {"a": 0.04, "b": !<tag:yaml.org,2002:float> "4e-2"}
)");
}

TEST_F(KeptFiles, CuroboInBlocks) {
  EXPECT_EQ(kept(SphereFormat::kCurobo, R"(robot_cfg:
  kinematics:
    usd_path: null
    flag: true
    "quoted": "1.0"
    version: 2.0
    no: "no"
    collision_link_names:
    - base
    - arm
    self_collision_ignore:
      base:
      - arm   # mine
      other:
      - base
    text: |
      # no comment
      two lines
    folded: a
      b
    lists: [[1, 2], {x: 3, ? [k] : {}}]
    "two\u2028lines": "\x07\U0001F916é"
    more: {null: ~, 1: "1", <<: {more: -1}}
    collision_spheres:
      base:
      - center:
        - 9.0
        - 9.0
        - 9.0
        radius: 9.0
  # end)"),
            R"(robot_cfg:
  kinematics:
    usd_path: null
    flag: true
    "quoted": "1.0"
    version: 2.0
    no: "no"
    collision_link_names:
      - base
      - arm
    self_collision_ignore:
      base:
        - arm
        - hand
      other:
        - base
      arm: [hand]
    text: "# no comment\ntwo lines\n"
    folded: a b
    lists: [[1, 2], {x: 3, [k]: {}}]
    "two\u2028lines": "\x07🤖é"
    more: {null: null, 1: "1", <<: {more: -1}}
    collision_spheres:)" +
                kSpheres);
}

// Beside the geometry that gets the spheres there is another one.
TEST_F(KeptFiles, XrdfOfTwoGeometries) {
  const std::string between = "  fine:\n    spheres: {}\nself_collision:\n";
  const std::string expected = kXrdf + kSpheres + between;
  const std::string pairs = "  ignore:\n    base: [arm, hand]\n    arm: [hand]\n";
  EXPECT_EQ(kept(SphereFormat::kXrdf, kXrdf + "\n" + between + "  ignore:\n  geometry: auto\n"),
            expected + pairs + "  geometry: auto\n");
  EXPECT_EQ(kept(SphereFormat::kXrdf, kXrdf + "\n" + between + "  geometry: auto\n"),
            expected + "  geometry: auto\n" + pairs);
}

TEST_F(KeptFiles, CuroboGetsAPlaceForPairs) {
  const std::string head = "kinematics:\n    collision_spheres:" + kSpheres;
  for (const std::string ignored :
       {"", "    self_collision_ignore: # none\n", "    self_collision_ignore: {}\n",
        "    self_collision_ignore: null\n", "    self_collision_ignore: ~\n",
        "    self_collision_ignore: {base: [], arm: , 'hand': ~ , \"b\": null}\n"}) {
    kept(SphereFormat::kCurobo, head + ignored);
  }
}

// A file of spheres alone says nothing of pairs; spheres are written where they are read.
TEST_F(KeptFiles, PairsAreNotAddedWhereNothingIsSaidOfSelfCollision) {
  const std::string text = written(SphereFormat::kCurobo,
                                   "\xef\xbb\xbf"
                                   "collision_spheres:\r\n  base: []\r\n...\r\n");
  EXPECT_EQ(text.find("ignore"), std::string::npos) << text;
  EXPECT_TRUE(read_robot_spheres(out_).spheres.self_collision_ignore.empty());
  spheres_.self_collision_ignore.clear();
  for (const std::string head :
       {"robot_cfg: {collision_spheres: {x: []}}\n", "robot_cfg: {kinematics: null}\n"}) {
    const std::string both = kept(SphereFormat::kCurobo, head + "collision_spheres:\n  base: []\n");
    EXPECT_TRUE(both.starts_with(head)) << both;
  }
}

// What an anchor holds stands at two places and is changed at one.
TEST_F(KeptFiles, AliasesAreWrittenOut) {
  const std::string text = kept(SphereFormat::kCurobo, R"(n: &n 1
kinematics:
  k: *n
  self_collision_ignore:
    other: &l [x]
    base: *l
  collision_spheres: &s {base: []}
  again: *s
)");
  for (const char* const part : {"n: 1\n", "  k: 1\n", "    other: [x]\n",
                                 "    base: [x, arm, hand]\n", "  again: {base: []}\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  }
}

TEST_F(KeptFiles, WhatCannotBeKeptIsRefused) {
  const std::string spheres = "collision_spheres: {a: []}\n";
  const std::string too_much = "is too deep, or too long with its aliases";
  std::string bomb = spheres + "l0: &l0 [x, x]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "*l" + std::to_string(i - 1);
    bomb += "l" + std::to_string(i) + ": &l" + std::to_string(i) + " [" + before + ", " + before +
            "]\n";
  }
  std::string wide = spheres + "t: &t " + std::string(1 << 16, 'x') + "\nall: [*t";
  for (int i = 0; i < 300; ++i) wide += ", *t";
  // Control characters have to be escaped, which makes a name four times as long.
  const std::string name = "held" + std::string(300, '\x06');
  const std::pair<std::string, std::string> refusals[] = {
      {spheres + "loop: &a [*a]\n", too_much},
      {bomb, too_much},
      {wide + "]\n", too_much},
      {spheres + "text: '\xff'\n", "is not UTF-8"},
      {"collision_spheres:\n  " + name + ": []\n", "too long for a key of YAML"},
      {"kinematics: {k: 1}\n", "has no place for spheres"},
      {"a: [1", "is not YAML"},
      {"kinematics: {collision_spheres: {}, self_collision_ignore: {a: b}}", "are not a list"}};
  for (const auto& [original, reason] : refusals) {
    expect_refusal(SphereFormat::kCurobo, original, reason);
  }
  expect_refusal(SphereFormat::kSrdf, "<robot>", "is not XML");
  expect_refusal(SphereFormat::kSrdf, "<sdf/>", "SDF");
}

// What is attached has places in the file that are switched off, and other links spheres of their
// own. A link that cuRobo was not told of has its spheres replaced where it gets some.
TEST_F(KeptFiles, SpheresThatAreSwitchedOffOrOfOtherLinksStay) {
  const std::string names = "kinematics:\n  collision_link_names: [base, hand, held]\n";
  const std::string old = R"(    base:
      - {center: [9, 9, 9], radius: 9}
      - {center: [0, 0, 1], radius: -10}
    held:
      - {center: [0, 0, 2], radius: -10}
      - {center: [0, 0, 3], radius: 0.5}
    arm: [{center: [7, 7, 7], radius: 7}, {center: [0, 0, 4], radius: 0}]
    hand:
      - {center: [0, 0, 5], radius: -0.01}
    camera: [{center: [0, 0, 6], radius: 6}]
)";
  const std::string expected = R"(kinematics:
  collision_link_names: [base, hand, held, arm]
  collision_spheres:
    base:
      - {center: [0.0, 0.0, 0.0], radius: 0.5}
      - {center: [0.0, 0.0, 1.0], radius: -10.0}
    arm:
      - {center: [1.0, 2.0, 3.0], radius: 0.25}
      - {center: [0.0, 0.0, 4.0], radius: 0.0}
    hand:
      - {center: [0.0, 0.0, 5.0], radius: -0.01}
    held:
      - {center: [0.0, 0.0, 3.0], radius: 0.5}
      - {center: [0.0, 0.0, 2.0], radius: -10.0}
    camera:
      - {center: [0.0, 0.0, 6.0], radius: 6.0}
)";
  spheres_.self_collision_ignore.clear();
  const auto write = [&](const std::string& text) { return written(SphereFormat::kCurobo, text); };
  EXPECT_EQ(write(names + "  collision_spheres:\n" + old), expected);
  folder_.write("spheres.yml", "collision_spheres:\n" + old);
  EXPECT_EQ(write(names + "  collision_spheres: spheres.yml\n"), expected) << "in a file beside";
  EXPECT_EQ(write("collision_spheres:\n  old: [{center: [0, 0, x], radius: 1}]\n"),
            write("collision_spheres:\n  base: []\n"))
      << "what cannot be read is replaced";
  const std::string held = "      held:\n        - {center: [0.0, 0.0, 2.0], radius: -10.0}\n";
  EXPECT_EQ(written(SphereFormat::kXrdf, kXrdf + "\n" + held), kXrdf + kSpheres + held);
}

// Links that are named like stand-ins of spheres, but have spheres of their own.
TEST_F(KeptFiles, UrdfKeepsLinksWithSpheresOfTheirOwn) {
  const std::filesystem::path urdf = folder_.write("robot.urdf", R"(<robot name="r">
  <link name="a"/>
  <link name="a_sphere0"><collision><geometry><sphere radius="1"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="a"/><child link="a_sphere0"/></joint>
</robot>)");
  const RobotSpheres spheres{.links = {{"a", {}}, {"a_sphere0", {{{0, 0, 0}, 1}}}}};
  write_robot_spheres(spheres, SphereFormat::kUrdf, {.urdf = urdf}, out_);
  const std::string text = read_file(out_);
  EXPECT_NE(text.find("<link name=\"a_sphere0\">"), std::string::npos) << text;
  EXPECT_NE(text.find("<child link=\"a_sphere0\""), std::string::npos) << text;
  EXPECT_NE(text.find("<sphere radius=\"1.0\""), std::string::npos) << text;
}

TEST_F(KeptFiles, Srdf) {
  EXPECT_EQ(kept(SphereFormat::kSrdf, R"(<?xml version='1.0' ?>
<!-- <robot> > -->
<robot   name='arm'
         xmlns:x = "y">
  <group name="all"> <link name="arm"/></group>
  <link_sphere_approximation link="old"><sphere center="0 0 0" radius="9"/></link_sphere_approximation>
    <disable_collisions link1="arm" link2="base" reason="User>" /> <!-- mine -->
    <disable_collisions   link1="x" link2="y"/>

  <property name="a>b" value='"/>'/><![CDATA[<a>]]>
</robot> <!-- end -->
)"),
            R"(<?xml version='1.0' ?>
<!-- <robot> > -->
<robot name="arm" xmlns:x="y">
    <group name="all">
        <link name="arm"/>
    </group>
    <link_sphere_approximation link="base">
        <sphere center="0.0 0.0 0.0" radius="0.5"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="arm">
        <sphere center="1.0 2.0 3.0" radius="0.25"/>
    </link_sphere_approximation>
    <link_sphere_approximation link="hand">
        <sphere center="0.0 0.0 0.0" radius="0.0"/>
    </link_sphere_approximation>
    <disable_collisions link1="arm" link2="base" reason="User&gt;"/>
    <!-- mine -->
    <disable_collisions link1="x" link2="y"/>
    <disable_collisions link1="hand" link2="base" reason="Never"/>
    <disable_collisions link1="arm" link2="hand"/>
    <property name="a&gt;b" value="&quot;/&gt;"/><![CDATA[<a>]]></robot>

<!-- end -->)");
}

TEST_F(KeptFiles, SrdfOfOneLineOrOfNone) {
  for (const std::string original :
       {"<robot name=\"arm\"/>", "<robot name=\"arm\"></robot>",
        "<robot name=\"arm\"><disable_collisions link1=\"arm\" link2=\"base\"/><group name=\"g\"/>"
        "</robot>\n",
        "<robot name=\"arm\">\r\n</robot>\r\n",
        "<robot name=\"arm\"><link_sphere_approximation link=\"x\"><sphere center=\"0 0 0\" "
        "radius=\"1\"/></link_sphere_approximation><!-- kept --><group name=\"g\"/></robot>",
        // More than what is well-formed is read, and what is written is.
        "<robot name=\"arm\">< link_sphere_approximation link=\"old\"><sphere center=\"0 0 0\" "
        "radius=\"9\"/></link_sphere_approximation></robot>"}) {
    const std::string text = kept(SphereFormat::kSrdf, original);
    for (const char* const part : {"<!-- kept -->", "<group name=\"g\"/>"}) {
      EXPECT_EQ(text.find(part) == std::string::npos, original.find(part) == std::string::npos);
    }
  }
}

// Somebody wants them to be tested.
TEST_F(KeptFiles, PairsThatAnSrdfEnablesAreNotDisabled) {
  written(SphereFormat::kSrdf,
          R"(<robot name="arm"><enable_collisions link1="base" link2="hand"/></robot>)");
  const std::vector<DisabledPair> pairs = read_srdf(out_).disabled_pairs;
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].link_b, "arm");
  EXPECT_EQ(pairs[1].link_b, "hand");
}

}  // namespace
}  // namespace spherule
