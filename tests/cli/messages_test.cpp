// SPDX-License-Identifier: BSD-3-Clause
// What the commands for robots say on standard error: one line for each error, whatever names hold,
// with the file in which a person has to look; and what they do not need.

#include "tests/cli/command_test_support.h"
#include "tests/support/child_process.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <string>
#include <sys/stat.h>
#include <vector>

namespace spherule {
namespace {

std::string urdf_of(const std::string& links, const std::string& robot = "r") {
  return "<robot name=\"" + robot + "\">" + links + "</robot>";
}

constexpr const char* kCube = R"(<geometry><box size="0.1 0.1 0.1"/></geometry>)";

// A cube that slides, with a shape of its own to be seen.
std::string sliding_cube(const std::string& visual, const std::string& collision) {
  return urdf_of("<link name=\"base\"/><link name=\"hand\"><visual>" + visual +
                 "</visual><collision>" + collision + R"(</collision></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>)");
}

std::string mesh(const std::string& name) {
  return "<geometry><mesh filename=\"" + name + "\"/></geometry>";
}

class MessagesTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("empty.json", R"({"format": "spherule-scene", "version": 1})");
    write("path.csv", "0\n1\n");
    write("hand.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
    write("two.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.1]},
                          "ghost": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
    write("cube.urdf", sliding_cube(kCube, kCube));
  }
  // A refusal that shows every character of the reason, and none that moves a cursor.
  void expect_readable(const std::vector<std::string>& arguments, const std::string& reason) {
    expect_refusal(arguments, reason);
    const std::string err = run(arguments).err;
    EXPECT_TRUE(std::all_of(err.begin(), err.end() - 1, [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
    })) << err;
  }
};

TEST_F(MessagesTest, AreOneLineWhateverNamesHold) {
  write("new\nline.stl", "nothing");
  expect_readable({"info", "new\nline.stl"}, "spherule: new\\nline.stl: ");
  expect_readable({"info", "bell\a\x1b[31m\r\t\x7f.stl"},
                  "spherule: bell\\x07\\x1b[31m\\r\\t\\x7f.stl: ");
  // Control characters of two bytes, half a character, characters written too long, half a pair;
  // letters of two, three and four bytes.
  expect_readable({"info", "\xc2\x9b\xe2\x82.\xc0\x80\xed\xa0\x80\xff"},
                  "spherule: \\xc2\\x9b\\xe2\\x82.\\xc0\\x80\\xed\\xa0\\x80\\xff: ");
  expect_readable({"info",
                   "gr\xc3\xb6\xc3\x9f"
                   "e \xe2\x82\xac \xf0\x9f\xa4\x96.stl"},
                  "spherule: gr\xc3\xb6\xc3\x9f"
                  "e \xe2\x82\xac \xf0\x9f\xa4\x96.stl: ");
  expect_readable({"fit", "part.stl", "-o", "no\nfolder/part.json", "--max-error", "1"},
                  "no\\nfolder/part.json: ");
  expect_readable({"info", "part.stl", "--un\nknown"}, "--un\\nknown");
  write("link.urdf", urdf_of("<link name=\"li&#10;nk\"><collision>" + mesh("go&#27;ne.stl") +
                             "</collision></link>"));
  expect_readable({"robot", "link.urdf", "-o", "out"}, "link.urdf: line 1: link 'li\\nnk': ");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obsta\ncles": []})");
  expect_readable({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                  "cell.json: the key 'obsta\\ncles'");
}

TEST_F(MessagesTest, AreExcerptsOfLongTexts) {
  std::string name;
  for (int i = 0; i < 100000; ++i) name += "\xc3\xb6";
  write("long.yml", "collision_spheres: " + name + "x\n");
  expect_readable({"info", "long.yml"}, "spherule: ");  // of the file that it names
  const std::string err = run({"info", "long.yml"}).err;
  EXPECT_LT(err.size(), 5000u);
  EXPECT_NE(err.find("\xc3\xb6 [...] \xc3\xb6"), std::string::npos) << err;
}

TEST_F(MessagesTest, WarningsAreOneLineToo) {
  write("cube.urdf", urdf_of("<link name=\"ba&#10;se\"><collision>" + std::string(kCube) +
                             R"(</collision></link><link name="hand"/>
    <joint name="slide" type="prismatic"><parent link="ba&#10;se"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>)"));
  const Outcome outcome =
      run({"check", "cube.urdf", "empty.json", "path.csv", "--spheres", "hand.json"});
  EXPECT_EQ(outcome.err,
            "spherule: warning: link ba\\nse has a shape but no spheres: it is not checked\n");
}

// What is wrong is in the user's files, not in those that the command tries out.
TEST_F(MessagesTest, NameTheUsersFile) {
  write("seen.urdf",
        urdf_of("<link name=\"base\"><visual>" + std::string(kCube) + "</visual></link>"));
  write("bare.urdf", urdf_of("<link name=\"base\"/>"));
  const std::string hint = "; --geometry visual takes the other one\n";
  expect_refusal({"robot", "seen.urdf", "-o", "out"},
                 "spherule: seen.urdf: no link has collision geometry" + hint);
  expect_refusal({"audit-robot", "seen.urdf", "hand.json"},
                 "spherule: seen.urdf: no link has collision geometry" + hint);
  write("cube.srdf", R"(<robot name="r"><disable_collisions link1="a" link2="b"/></robot>)");
  expect_refusal({"check-srdf", "seen.urdf", "cube.srdf"},
                 "spherule: seen.urdf: no link has collision geometry" + hint);
  expect_refusal({"robot", "bare.urdf", "-o", "out", "--geometry", "visual"},
                 "spherule: bare.urdf: no link has visual geometry\n");
  write("name.urdf", urdf_of("<link name=\"ba&#10;se\"><collision>" + std::string(kCube) +
                             "</collision></link>"));
  expect_refusal({"robot", "name.urdf", "-o", "out", "--effort", "0"},
                 "spherule: out/r.curobo.yml: the name of a link, 'ba\\nse', holds a control "
                 "character\n");
  EXPECT_FALSE(exists("out"));
  write("robot.urdf",
        urdf_of("<link name=\"base\"><collision>" + std::string(kCube) + "</collision></link>",
                "a/b"));
  expect_refusal({"robot", "robot.urdf", "-o", "out"}, "spherule: robot.urdf: ");
  write(
      "slash.urdf",
      urdf_of("<link name=\"b\"><collision>" + std::string(kCube) + "</collision></link>", "../b"));
  expect_refusal({"robot", "slash.urdf", "-o", "out", "--format", "tree"},
                 "spherule: slash.urdf: the name '../b' cannot be part of that of a file\n");
  write("huge.urdf", urdf_of(R"(<link name="base"><collision><geometry><box size="1e4 1e4 1e4"/>
    </geometry></collision></link>)"));
  expect_refusal({"robot", "huge.urdf", "-o", "out"}, "spherule: huge.urdf: link 'base': is ");
  write("cell.json", R"({"format": "spherule-scene", "version": 1,
    "allowed_contacts": [{"body": "arm", "other": "hand"}]})");
  expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                 "spherule: cell.json: arm: there is no link or attached object of that name");
  write("cell.json", R"({"format": "spherule-scene", "version": 1,
    "allowed_contacts": [{"body": "hnad", "other": "base"}]})");
  expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                 "of that name; did you mean hand?");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstcales": []})");
  expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                 "the key 'obstcales' is not known here; did you mean obstacles?");
  expect_refusal({"robot", "cube.urdf", "-o", "out", "--link", "bsae:max-error=0.01"},
                 "link 'bsae': the robot has no such link; did you mean base?");
  expect_refusal({"robot", "cube.urdf", "-o", "out", "--max-error", "20"},
                 "max error: 20 m is far more than any link is across");
  write("cell.json", R"({"format": "spherule-scene", "version": 1,
    "attached": [{"name": "tool", "link": "gone", "spheres": {"file": "tool.json"}}]})");
  write_spheres("tool.json", {{0.0, 0.0, 0.0, 0.1}});
  expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                 "spherule: cell.json: link gone: the robot has no such link");
}

// A mesh that is not used may be missing.
TEST_F(MessagesTest, OnlyMeshesOfTheGeometryAreNeeded) {
  const std::string missing = mesh("package://gone/hand.dae");
  write("seen.urdf", sliding_cube(missing, kCube));
  write("solid.urdf", sliding_cube(kCube, missing));
  write("cube.srdf", R"(<robot name="r"><disable_collisions link1="base" link2="hand"/></robot>)");
  const std::vector<std::vector<std::string>> commands = {
      {"robot", "", "-o", "out", "--max-error", "0.04", "--effort", "0"},
      {"check", "", "empty.json", "path.csv", "--max-error", "0.04", "--effort", "0"},
      {"view", "", "-o", "page.html"},
      {"check-srdf", "", "cube.srdf"},
      {"audit-robot", "", "hand.json"}};
  for (std::vector<std::string> line : test::effort(commands, 4)) {
    SCOPED_TRACE(line.front());
    line[1] = "seen.urdf";
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    line[1] = "solid.urdf";
    expect_refusal(line, "spherule: solid.urdf: line 1: link 'hand': <mesh>: package://gone");
    line.insert(line.end(), {"--geometry", "visual"});
    const Outcome visual = run(line);
    EXPECT_EQ(visual.exit_code, 0) << visual.err;
    line[1] = "seen.urdf";
    expect_refusal(line, "spherule: seen.urdf: line 1: link 'hand': <mesh>: package://gone");
  }
  expect_refusal({"view", "seen.urdf", "-o", "page.html", "--geometry", "collision,visual"},
                 "package://gone");
  // With spheres that are given no mesh is read at all.
  write("none.urdf", sliding_cube(missing, missing));
  EXPECT_EQ(
      run({"check", "none.urdf", "empty.json", "path.csv", "--spheres", "hand.json"}).exit_code, 0);
}

TEST_F(MessagesTest, SpheresOfLinksThatAreNotThereAreRefusedOrLeftOut) {
  const std::string what = "two.json: has spheres of 1 link that the robot has not got: 'ghost'";
  const std::vector<std::vector<std::string>> commands = {
      {"check", "cube.urdf", "empty.json", "path.csv", "--spheres", ""},
      {"view", "cube.urdf", "-o", "page.html", ""},
      {"audit-robot", "cube.urdf", ""}};
  for (std::vector<std::string> line : test::effort(commands, 2)) {
    SCOPED_TRACE(line.front());
    line.back() = "two.json";
    expect_refusal(line, "spherule: " + what + "; --ignore-unknown-links leaves them out\n");
    line.push_back("--ignore-unknown-links");
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "spherule: warning: " + what + "; they are left out\n");
    *(line.end() - 2) = "hand.json";
    EXPECT_EQ(run(line).err, "");
    // If all are, the file is of another robot.
    *(line.end() - 2) = "others.json";
    std::string others;
    for (int i = 0; i < 8; ++i) {
      others += (i == 0 ? "{\"link" : ", \"link") + std::to_string(i) +
                "\": {\"centers\": [[0, 0, 0]], \"radii\": [0.1]}";
    }
    write("others.json", others + "}");
    expect_refusal(line,
                   "spherule: others.json: has spheres of 8 links that the robot has not got: "
                   "'link0', 'link1', 'link2', 'link3', 'link4' and 3 more, and of no other\n");
  }
}

// Links without spheres are no loss, and pairs of links that are not there need no test.
TEST_F(MessagesTest, WhatIsNotThereAndHasNoSpheresIsNoFault) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write("cube.yml",
        "collision_spheres:\n  hand: [{center: [0, 0, 0], radius: 0.1}]\n"
        "  ghost: [{center: [0, 0, 0], radius: -1}]\n"
        "self_collision_ignore: {hand: [attached_object], other: [hand]}\n");
  for (const std::vector<std::string>& line :
       {std::vector<std::string>{"audit-robot", "cube.urdf", "cube.yml"},
        std::vector<std::string>{"view", "cube.urdf", "cube.yml", "-o", "page.html"}}) {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  const Outcome check =
      run({"check", "cube.urdf", "empty.json", "path.csv", "--spheres", "cube.yml"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_EQ(check.err,
            "spherule: warning: cube.yml: 1 spheres are switched off: they are not checked\n");
}

// Whatever names a file holds, what the command prints of it has no character that a terminal
// obeys, and no line but its own.
TEST_F(MessagesTest, StandardOutputHasNoControlCharacters) {
  const auto shown = [&](const std::vector<std::string>& arguments, const std::string& part) {
    const Outcome outcome = run(arguments);
    EXPECT_LE(outcome.exit_code, 1) << outcome.err;
    EXPECT_TRUE(std::all_of(outcome.out.begin(), outcome.out.end(), [](char c) {
      return c == '\n' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
    })) << outcome.out;
    EXPECT_EQ(outcome.out.find("\xc2\x9b"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find(part), std::string::npos) << outcome.out;
    return outcome.out;
  };
  write("arm.urdf", urdf_of(R"(<link name="base"/><link name="ha&#10;nd"><collision>)" +
                                std::string(kCube) + R"(</collision></link>
    <joint name="sl&#127;ide" type="prismatic"><parent link="base"/><child link="ha&#10;nd"/>
      <axis xyz="1 0 0"/><limit lower="-0.5" upper="0.5" effort="1" velocity="1"/></joint>)",
                            "r&#27;[31mX&#7;"));
  write("arm.json", R"({"format": "spherule-robot-spheres", "version": 1, "robot": "r\u001b",
    "links": [{"link": "ha\nnd", "spheres": [{"center": [0, 0, 0], "radius": 0.05}]}]})");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "wa\u009bll\u007f", "box": {"size": [1, 1, 1]}}]})");
  shown({"info", "arm.urdf"}, "robot: r\\x1b[31mX\\x07\n");
  shown({"info", "arm.urdf"}, "  sl\\x7fide: -0.5 to 0.5 m\n");
  shown({"info", "arm.json"}, ": r\\x1b\n");
  shown({"info", "arm.json"}, "  ha\\nnd: 1\n");
  std::vector<std::string> check = {"check",     "arm.urdf", "cell.json",       "path.csv",
                                    "--spheres", "arm.json", "--enforce-limits"};
  EXPECT_NE(shown(check, "ha\\nnd  wa\\xc2\\x9bll\\x7f").find("joint sl\\x7fide at 1 m"),
            std::string::npos);
  check.push_back("--json");
  EXPECT_EQ(nlohmann::json::parse(shown(check, "wa\\u009bll\\u007f"))["pairs"][0]["second"],
            "wa\xc2\x9bll\x7f");
  shown({"audit-robot", "arm.urdf", "arm.json"}, "\nha\\nnd ");
  write("arm.srdf", R"(<robot name="r&#27;"><disable_collisions link1="base" link2="ha&#10;nd"/>
    <disable_collisions link1="a&#27;" link2="b"/></robot>)");
  shown({"info", "arm.srdf"}, "SRDF of robot: r\\x1b\n");
  write_spheres("spheres.json", {{0.0, 0.0, 0.0, 0.1}});
  shown({"tree", "spheres.json", "-o", "a'\a.tree"},
        "a'\\x07.tree: 1 spheres, 1 nodes, depth 0, branching ");
  shown({"tree", "spheres.json", "-o", "a'\a.tree"}, "next: spherule collide $'a\\'\\x07.tree' ");
}

// A pipe that a file names would be waited for without an end; on the command line it is meant.
TEST_F(MessagesTest, OnlyRegularFilesAreReadForNamesInFiles) {
  for (const char* pipe : {"pipe", "pipe.xyz", "pipe.json"}) {
    ASSERT_EQ(::mkfifo((folder_ / pipe).c_str(), 0600), 0);
  }
  const std::string reason = " is not a regular file\n";
  write("side.yml", "collision_spheres: pipe\n");
  expect_refusal({"info", "side.yml"}, "spherule: side.yml: \"collision_spheres\": pipe:" + reason);
  for (const std::string shape :
       {R"("spheres": {"file": "pipe.json"})", R"("tree": {"file": "pipe"})",
        R"("points": {"file": "pipe.xyz", "radius": 0.1})", R"("mesh": {"file": "pipe"})"}) {
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "a", )" + shape +
                           "}]}");
    expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                   reason);
  }
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "robot": {"srdf": "pipe"}})");
  expect_refusal({"check", "cube.urdf", "cell.json", "path.csv", "--spheres", "hand.json"},
                 "spherule: pipe:" + reason);
}

// Nothing is written but what is asked for, so that there is nothing to leave behind.
TEST_F(MessagesTest, NoFolderForTemporaryFilesIsNeeded) {
  const auto run_in_shell = [&](const std::string& script) {
    return finish(start_process("/bin/sh", {"-c", script, SPHERULE_COMMAND},
                                {.folder = folder_, .out = ".out", .error = ".err"}));
  };
  const Outcome robot = run_in_shell(
      "TMPDIR=/nonexistent exec \"$0\" robot cube.urdf -o out --max-error 0.04 --effort 0 --format "
      "urdf --proofs none --postures 5");
  EXPECT_EQ(robot.exit_code, 0) << robot.err;
  write_spheres("spheres.json", {{0.0, 0.0, 0.0, 0.1}});
  const Outcome tree = run_in_shell(
      "here=$PWD; mkdir gone; cd gone; rmdir ../gone; exec \"$0\" tree \"$here/spheres.json\" -o "
      "x.tree");
  EXPECT_EQ(tree.exit_code, 2);
  EXPECT_EQ(tree.err, "spherule: x.tree: no working directory: No such file or directory\n");
}

TEST_F(MessagesTest, AnotherGeometryForSelfCollisionsIsTold) {
  write("cube.xrdf",
        "format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\n"
        "self_collision: {geometry: own}\ngeometry:\n"
        "  g: {spheres: {hand: [{center: [0, 0, 0], radius: 0.1}]}}\n  own: {spheres: {}}\n");
  const Outcome check =
      run({"check", "cube.urdf", "empty.json", "path.csv", "--spheres", "cube.xrdf"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_EQ(check.err,
            "spherule: warning: cube.xrdf: the geometry 'own' that it names for self-collisions is "
            "not read: these are checked with the spheres of the geometry for collisions, too\n");
}

TEST_F(MessagesTest, OpenMeshesOfLinksAreExplainedOnce) {
  write("sheet.obj", "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nf 1 2 3\n");
  const std::string sheet =
      R"("><visual><geometry><mesh filename="sheet.obj"/></geometry></visual></link>)";
  write("sheet.urdf", R"(<robot name="sheet"><link name="base)" + sheet + R"(<link name="tip)" +
                          sheet + R"(<joint name="j" type="fixed"><parent link="base"/>
           <child link="tip"/></joint></robot>)");
  std::vector<std::string> expected = files();
  expected.insert(expected.end(), {"sheet.base.tree", "sheet.report.json", "sheet.tip.tree"});
  std::sort(expected.begin(), expected.end());
  const Outcome result = run({"robot", "sheet.urdf", "-o", ".", "--geometry", "visual", "--effort",
                              "0", "--format", "tree"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(files(), expected);
  // It is explained once; the report explains it of each.
  const std::string figures = "its mesh is open (3 edges with one triangle, 0 with more than two)";
  const std::string why = ": the surface is covered in any case";
  EXPECT_TRUE(result.err.starts_with("spherule: warning: link base: " + figures + why))
      << result.err;
  EXPECT_NE(result.err.find("\nspherule: warning: link tip: " + figures + "\n"), std::string::npos)
      << result.err;
  const nlohmann::json report = read_json("sheet.report.json");
  for (const nlohmann::json& link : report.at("links")) {
    EXPECT_TRUE(link.at("warnings").at(0).get<std::string>().starts_with(figures + why));
  }
  // An audit says it, too, whatever it finds.
  const std::string sphere = R"(, "spheres": [{"center": [0.05, 0.05, 0], "radius": 0.075}]})";
  write("sheet.json", R"({"format": "spherule-robot-spheres", "version": 1, "robot": "sheet",
    "links": [{"link": "base")" +
                          sphere + R"(, {"link": "tip")" + sphere + "]}");
  const Outcome audit = run({"audit-robot", "sheet.urdf", "sheet.json", "--geometry", "visual"});
  EXPECT_EQ(audit.exit_code, 0) << audit.out;
  EXPECT_TRUE(audit.err.starts_with("spherule: warning: link base: " + figures +
                                    ": its surface is judged in any case"))
      << audit.err;
  EXPECT_TRUE(audit.err.ends_with("\nspherule: warning: link tip: " + figures + "\n")) << audit.err;
}

}  // namespace
}  // namespace spherule
