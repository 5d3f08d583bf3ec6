// SPDX-License-Identifier: BSD-3-Clause
// What an SRDF file says, and what is no SRDF file.

#include "base/error.h"
#include "robot/files/robot_description.h"
#include "tests/robot/refusals.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace spherule::test::srdf_test {
namespace {

std::string robot_of(const std::string& elements) {
  return "<robot name='r'>" + elements + "</robot>";
}

SemanticDescription read_text(const std::string& text) {
  const TempDir folder;
  return read_srdf(folder.write("robot.srdf", text));
}

const auto read_file = [](const std::filesystem::path& file) { read_srdf(file); };

constexpr const char* kRobot = R"(<?xml version="1.0"?>
    <!-- a robot -->
    <robot name="arm">
      <virtual_joint name="v" type="floating" parent_frame="world" child_link="base"/>
      <group name="both"> <group name="left"/> <joint name="j2"/> </group>
      <group name="left"> <chain base_link="base" tip_link="l1"/> <link name="l2"/> </group>
      <group_state name="home" group="left">
        <joint name="j1" value=" -0.5 "/> <joint name="v" value="0 0 1 0 0 0 1"/>
      </group_state>
      <end_effector name="hand" group="left" parent_link="l1" parent_group="both"/>
      <end_effector name="hook" group="left" parent_link="l2"/>
      <passive_joint name="j9"/>
      <disable_collisions link1="base" link2="l1" reason="Adjacent"/>
      <disable_collisions link1="l2" link2="base"/>
      <link_sphere_approximation link="l1">
        <sphere center="0.1 -0.2 3e-1" radius="0.25"/> <sphere center="0 0 0" radius="0"/>
        <sphere center="1 1 1" radius="2"/>
      </link_sphere_approximation>
      <link_sphere_approximation link="l2"> <sphere center="0 0 0" radius="0"/>
      </link_sphere_approximation>
    </robot>)";

TEST(ReadSrdf, ReadsWhatIsThere) {
  const SemanticDescription read = read_text(kRobot);
  EXPECT_EQ(read.robot_name, "arm");
  ASSERT_EQ(read.groups.size(), 2U);
  EXPECT_EQ(read.groups[0].name, "both");
  EXPECT_EQ(read.groups[0].subgroups, std::vector<std::string>{"left"});
  EXPECT_EQ(read.groups[0].joints, std::vector<std::string>{"j2"});
  EXPECT_EQ(read.groups[1].links, std::vector<std::string>{"l2"});
  ASSERT_EQ(read.groups[1].chains.size(), 1U);
  EXPECT_EQ(read.groups[1].chains[0].base_link, "base");
  EXPECT_EQ(read.groups[1].chains[0].tip_link, "l1");
  ASSERT_EQ(read.group_states.size(), 1U);
  EXPECT_EQ(read.group_states[0].name, "home");
  EXPECT_EQ(read.group_states[0].group, "left");
  ASSERT_EQ(read.group_states[0].joints.size(), 2U);
  EXPECT_EQ(read.group_states[0].joints[0].joint, "j1");
  EXPECT_EQ(read.group_states[0].joints[0].position, std::vector<double>{-0.5});
  EXPECT_EQ(read.group_states[0].joints[1].position.size(), 7U);
  ASSERT_EQ(read.end_effectors.size(), 2U);
  EXPECT_EQ(read.end_effectors[0].name, "hand");
  EXPECT_EQ(read.end_effectors[0].group, "left");
  EXPECT_EQ(read.end_effectors[0].parent_link, "l1");
  EXPECT_EQ(read.end_effectors[0].parent_group, "both");
  EXPECT_EQ(read.end_effectors[1].parent_group, "");
  ASSERT_EQ(read.disabled_pairs.size(), 2U);
  EXPECT_EQ(read.disabled_pairs[0].link_a, "base");
  EXPECT_EQ(read.disabled_pairs[0].link_b, "l1");
  EXPECT_EQ(read.disabled_pairs[0].reason, "Adjacent");
  EXPECT_EQ(read.disabled_pairs[1].reason, "");
  ASSERT_EQ(read.sphere_approximations.size(), 2U);
  EXPECT_EQ(read.sphere_approximations[0].link, "l1");
  ASSERT_EQ(read.sphere_approximations[0].spheres.size(), 2U);
  EXPECT_EQ(read.sphere_approximations[0].spheres[0].center, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(read.sphere_approximations[0].spheres[0].radius, 0.25);
  EXPECT_EQ(read.sphere_approximations[0].spheres[1].radius, 2.0);
  EXPECT_TRUE(read.sphere_approximations[1].spheres.empty());
}

TEST(ReadSrdf, TellsWhatTheRobotHasNotGot) {
  RobotModel robot("base");
  robot.add_link("l1", "base", {.name = "j1", .type = JointType::kRevolute});
  robot.add_link("l2", "l1", {.name = "j2"});
  EXPECT_EQ(unknown_names(read_text(kRobot), robot),
            std::vector<std::string>{"state home: there is no joint v"});
  const std::string others = robot_of(
      "<group name='g'><link name='a'/><joint name='b'/><chain base_link='c' tip_link='d'/>"
      "</group><end_effector name='e' group='g' parent_link='f'/>"
      "<disable_collisions link1='h' link2='i'/><link_sphere_approximation link='k'/>");
  EXPECT_EQ(unknown_names(read_text(others), robot),
            (std::vector<std::string>{
                "group g: there is no link a", "group g: there is no joint b",
                "group g: there is no link c", "group g: there is no link d",
                "end effector e: there is no link f", "disabled pair: there is no link h",
                "disabled pair: there is no link i", "sphere approximation: there is no link k"}));
}

using Pairs = std::vector<std::pair<std::string, std::string>>;

Pairs names_of(const std::vector<DisabledPair>& pairs) {
  Pairs names;
  for (const DisabledPair& pair : pairs) names.emplace_back(pair.link_a, pair.link_b);
  return names;
}

// As MoveIt's matrix is made: defaults first, then what is enabled, then what is disabled.
TEST(ReadSrdf, LinksMayBeDisabledByDefault) {
  const SemanticDescription read = read_text(
      robot_of("<disable_default_collisions link='x'/><disable_default_collisions link='y'/>"
               "<enable_collisions link1='a' link2='x'/><enable_collisions link1='b' link2='y'/>"
               "<enable_collisions link1='a' link2='b'/>"
               "<disable_collisions link1='y' link2='b' reason='Never'/>"));
  EXPECT_EQ(read.links_disabled_by_default, (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(read.warnings.empty());
  const std::vector<std::string> links = {"a", "x", "b", "y"};
  const std::vector<DisabledPair> disabled = disabled_among(read, links);
  EXPECT_EQ(names_of(disabled), (Pairs{{"y", "b"}, {"x", "b"}, {"x", "y"}, {"y", "a"}}));
  EXPECT_EQ(disabled[0].reason, "Never");
  EXPECT_EQ(disabled[1].reason, kDisabledByDefault);
  EXPECT_EQ(enabled_only(read), (Pairs{{"a", "x"}, {"a", "b"}}));
  EXPECT_TRUE(disabled_among(SemanticDescription(), links).empty());
  RobotModel robot("a");
  EXPECT_EQ(unknown_names(read, robot).front(), "disabled pair: there is no link y");
  EXPECT_EQ(unknown_names(read, robot)[2], "disabled by default: there is no link x");
}

TEST(ReadSrdf, WarnsOfElementsThatAreNotKnown) {
  const SemanticDescription read = read_text(robot_of(
      "<joint_property joint_name='j' property_name='p' value='v'/><passive_joint name='j'/>"
      "<virtual_joint name='v' type='fixed' parent_frame='w' child_link='a'/>\n"
      "<collision_margins default_margin='0.1'/><collision_margins default_margin='0.2'/>\n"
      "<group name='g'><frame name='f'/></group>"));
  ASSERT_EQ(read.warnings.size(), 2U);
  EXPECT_TRUE(read.warnings[0].ends_with(
      "robot.srdf: line 2: <collision_margins>: it is not known there and is ignored"))
      << read.warnings[0];
  EXPECT_TRUE(
      read.warnings[1].ends_with("line 3: frame 'f': <frame>: it is not known there and "
                                 "is ignored"))
      << read.warnings[1];
}

TEST(ReadSrdf, TellsOfSoManyNamesOnly) {
  std::string links;
  for (std::size_t i = 0; i <= kMostUnknownNames; ++i) links += "<link name='a'/>";
  const SemanticDescription semantics =
      read_text(robot_of("<group name='g'>" + links + "</group>"));
  EXPECT_EQ(unknown_names(semantics, RobotModel("base")).size(), kMostUnknownNames);
}

TEST(ReadSrdf, RefusesBadFiles) {
  const auto spheres = [](const std::string& sphere) {
    return robot_of("<link_sphere_approximation link='a'>\n<sphere " + sphere +
                    "/></link_sphere_approximation>");
  };
  const std::string group = "<group name='g'/>";
  const std::vector<BadText> files = {
      {"", {"not XML"}},
      {"<robot name='r'>", {"not XML"}},
      {"<srdf/>", {"no <robot>"}},
      {"<robot/>", {"no name"}},
      {robot_of("<group/>"), {"<group>", "no name"}},
      {robot_of(group + group), {"<group>", "already"}},
      {robot_of("<group name='g'><joint/></group>"), {"group 'g'", "<joint>", "no name"}},
      {robot_of("<group name='g'><link name=''/></group>"), {"group 'g'", "<link>", "no name"}},
      {robot_of("<group name='g'><chain base_link='a'/></group>"), {"'g'", "no tip_link"}},
      {robot_of("<group name='g'><group name='h'/></group>"), {"'g'", "no group 'h'"}},
      {robot_of("<group name='g'><group name='g'/></group>"), {"'g'", "within itself"}},
      {robot_of(group + "<group name='h'><group name='i'/><group name='g'/></group>"
                        "<group name='i'><group name='h'/></group>"),
       {"group 'h'", "within itself"}},
      {robot_of("<group_state name='s' group='g'/>"), {"no group 'g'"}},
      {robot_of(group + "<group_state name='s'/>"), {"no group"}},
      {robot_of(group + "<group_state name='s' group='g'/><group_state name='s' group='g'/>"),
       {"'s'", "already"}},
      {robot_of(group + "<group_state name='s' group='g'><joint name='j'/></group_state>"),
       {"joint 'j'", "no value"}},
      {robot_of(group +
                "<group_state name='s' group='g'><joint name='j' value=' '/></group_state>"),
       {"joint 'j'", "no value"}},
      {robot_of(group +
                "<group_state name='s' group='g'><joint name='j' value='1 x'/></group_state>"),
       {"joint 'j'", "'x'"}},
      {robot_of(group + "<group_state name='s' group='g'><joint name='j' value='1'/>"
                        "<joint name='j' value='2'/></group_state>"),
       {"joint 'j'", "already"}},
      {robot_of("<end_effector name='e' group='g' parent_link='l'/>"), {"'e'", "no group 'g'"}},
      {robot_of(group + "<end_effector name='e' group='g'/>"), {"'e'", "no parent_link"}},
      {robot_of(group + "<end_effector name='e' group='g' parent_link='l' parent_group='h'/>"),
       {"'e'", "no group 'h'"}},
      {robot_of(group + "<end_effector name='e' group='g' parent_link='l'/>"
                        "<end_effector name='e' group='g' parent_link='m'/>"),
       {"'e'", "already"}},
      {robot_of("<disable_collisions link1='a'/>"), {"<disable_collisions>", "no link2"}},
      {robot_of("<disable_collisions link1='a' link2='a'/>"), {"with itself"}},
      {robot_of("<disable_default_collisions/>"), {"<disable_default_collisions>", "no link"}},
      {robot_of("<enable_collisions link1='a'/>"), {"<enable_collisions>", "no link2"}},
      {robot_of("<enable_collisions link1='a' link2='a'/>"), {"with itself"}},
      {robot_of("<xacro:include filename='a'/>"), {"<xacro:include>", "ends in .xacro"}},
      {robot_of("<disable_collisions link1='a' link2='\xFF'/>"), {"UTF-8"}},
      {robot_of("<link_sphere_approximation/>"), {"no link"}},
      {robot_of("<link_sphere_approximation link='a'/><link_sphere_approximation link='a'/>"),
       {"already"}},
      {spheres("radius='1'"), {"line 2", "<sphere>", "no center"}},
      {spheres("center='0 0 0'"), {"no radius"}},
      {spheres("center='0 0' radius='1'"), {"2 numbers"}},
      {spheres("center='0 0 0.1.2' radius='1'"), {"'0.1.2'"}},
      {spheres("center='0 0 0' radius='inf'"), {"'inf'"}},
      {spheres("center='0 0 0' radius='-1'"), {"below zero"}},
      {spheres("center='0 0 0' radius='1e16'"), {"too large"}},
      {spheres("center='0 -1e16 0' radius='1'"), {"too large"}},
  };
  expect_refusals(files, read_file);
  EXPECT_THROW(read_srdf("no such file.srdf"), Error);
}

// Each fault that the parser of XML tells apart has its own words.
TEST(ReadSrdf, SaysWhatIsNotXml) {
  const std::vector<BadText> cases = {
      {"", {"is not XML: nothing is in it"}},
      {"<robot>\n<group></robot>",
       {"line 2: is not XML: an element is not closed, or by the tag of another"}},
      {"<robot>", {"line 1: is not XML: an element is not closed"}},
      {"<robot><link name='a' name='b'/></robot>", {"an attribute is there twice, or not written"}},
      {"<robot><link name=a/></robot>", {"an attribute is there twice, or not written"}},
      {"<robot><!-- </robot>", {"a comment is not ended"}},
      {"<robot><![CDATA[ </robot>", {"a CDATA section is not ended"}},
      {"<robot><? </robot>", {"a declaration is not ended, or not at the beginning"}},
      {"<robot><! </robot", {"a tag that begins with <! is not ended"}},
      {"<robot", {"a tag is not complete"}}};
  expect_refusals(cases, read_file);
}

}  // namespace
}  // namespace spherule::test::srdf_test
