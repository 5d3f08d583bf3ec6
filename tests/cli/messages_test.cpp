// SPDX-License-Identifier: BSD-3-Clause
// What the commands for robots say on standard error: one line for each error, whatever names hold,
// with the file in which a person has to look; and what they do not need.
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <sys/stat.h>

namespace spherule {
namespace {

using nlohmann::json;

std::string urdf_of(const std::string& links, const std::string& robot = "r") {
  return "<robot name=\"" + robot + "\">" + links + "</robot>";
}

std::string mesh(const std::string& kind, const std::string& name) {
  return "<" + kind + "><geometry><mesh filename=\"" + name + "\"/></geometry></" + kind + ">";
}

const std::string kSeen = box("visual", "0.1 0.1 0.1");
const std::string kSolid = box("collision", "0.1 0.1 0.1");

class MessagesTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("empty.json", scene(""));
    write("path.csv", "0\n1\n");
    write("hand.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
    write("two.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.1]},
                          "ghost": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
    write("cube.urdf", sliding("r", "", kSeen + kSolid));
  }
  // A refusal that shows every character of the reason, and none that moves a cursor.
  void expect_readable(const Words& arguments, const std::string& reason) {
    expect_refusal(arguments, reason);
    const std::string err = run(arguments).err;
    EXPECT_TRUE(std::all_of(err.begin(), err.end() - 1, [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F;
    })) << err;
  }
};

// What is wrong is in the user's files, not in those that the command tries out; every message is
// one line, whatever names hold.
TEST_F(MessagesTest, NameTheUsersFileInOneLine) {
  const std::string seen = "<link name=\"base\">" + kSeen + "</link>";
  const auto with = [](const std::string& keys) { return scene("", keys); };
  const std::string none = "x.urdf: no link has collision geometry; --geometry visual takes";
  const std::string check = "check cube.urdf cell.json path.csv --spheres hand.json";
  write("cube.srdf", R"(<robot name="r"><disable_collisions link1="a" link2="b"/></robot>)");
  struct Case {
    std::string file, text;
    Words arguments;
    std::string reason;
  };
  const std::vector<Case> cases = {
      {"x.urdf", urdf_of(seen), "robot x.urdf -o out", none},
      {"x.urdf", urdf_of(seen), "audit-robot x.urdf hand.json", none},
      {"x.urdf", urdf_of(seen), "check-srdf x.urdf cube.srdf", none},
      {"x.urdf", urdf_of("<link name=\"b\"/>"), "robot x.urdf -o out --geometry visual",
       "x.urdf: no link has visual geometry"},
      {"x.urdf", urdf_of("<link name=\"ba&#10;se\">" + kSolid + "</link>"),
       "robot x.urdf -o out --effort 0",
       "the name of a link, 'ba\\nse', holds a control character, which r.curobo.yml cannot hold"},
      {"x.urdf",
       urdf_of("<link name=\"li&#10;nk\">" + mesh("collision", "go&#27;ne.stl") + "</link>"),
       "robot x.urdf -o out", "x.urdf: line 1: link 'li\\nnk': "},
      {"x.urdf", urdf_of("<link name=\"b\">" + kSolid + "</link>", "../b"),
       "robot x.urdf -o out --format tree", "the name '../b' cannot be part of that of a file"},
      {"cell.json", with(R"("allowed_contacts": [{"body": "hnad", "other": "base"}])"), check,
       "cell.json: hnad: there is no link or attached object of that name; did you mean hand?"},
      {"cell.json", with(R"("obsta\ncles": [])"), check, "cell.json: the key 'obsta\\ncles'"},
      {"cell.json", with(R"("obstcales": [])"), check, "did you mean obstacles?"},
      {"cell.json",
       with(R"("attached": [{"name": "t", "link": "gone", "tree": {"file": "t.tree"}}])"), check,
       "cell.json: "},
      {"new\nline.stl", "nothing", {"info", "new\nline.stl"}, "spherule: new\\nline.stl: "},
      {"", "", {"info", "bell\a\x1b[31m\r\t\x7f.stl"}, "bell\\x07\\x1b[31m\\r\\t\\x7f.stl: "},
      // Control characters of two bytes, half a character, characters written too long, half a
      // pair; letters of two, three and four bytes.
      {"",
       "",
       {"info", "\xc2\x9b\xe2\x82.\xc0\x80\xed\xa0\x80\xff"},
       "spherule: \\xc2\\x9b\\xe2\\x82.\\xc0\\x80\\xed\\xa0\\x80\\xff: "},
      {"",
       "",
       {"info", "gr\u00f6\u00dfe \u20ac \U0001f916.stl"},
       "spherule: gr\u00f6\u00dfe \u20ac \U0001f916.stl: "},
      {"", "", {"fit", "part.stl", "-o", "no\nfolder/part.json"}, "no\\nfolder/part.json: "},
      {"", "", {"info", "part.stl", "--un\nknown"}, "--un\\nknown"},
  };
  for (const Case& one : cases) {
    if (!one.file.empty()) write(one.file, one.text);
    expect_readable(one.arguments, one.reason);
  }
  EXPECT_FALSE(exists("out"));
}

// Whatever names a file holds, no character of the output is one that a terminal obeys.
TEST_F(MessagesTest, StandardOutputHasNoControlCharacters) {
  write("arm.urdf", urdf_of(R"(<link name="base"/><link name="ha&#10;nd">)" + kSolid + R"(</link>
    <joint name="sl&#127;ide" type="prismatic"><parent link="base"/><child link="ha&#10;nd"/>
      <axis xyz="1 0 0"/><limit lower="-0.5" upper="0.5" effort="1" velocity="1"/></joint>)",
                            "r&#27;[31mX&#7;"));
  write("arm.json", R"({"format": "spherule-robot-spheres", "version": 1, "robot": "r\u001b",
    "links": [{"link": "ha\nnd", "spheres": [{"center": [0, 0, 0], "radius": 0.05}]}]})");
  write("cell.json", scene(R"({"name": "wa\u009bll\u007f", "box": {"size": [1, 1, 1]}})"));
  write("arm.srdf", R"(<robot name="r&#27;"><disable_collisions link1="base" link2="ha&#10;nd"/>
    <disable_collisions link1="a&#27;" link2="b"/></robot>)");
  write_spheres("spheres.json", {{0.0, 0.0, 0.0, 0.1}});
  const std::string check = "check arm.urdf cell.json path.csv --spheres arm.json --enforce-limits";
  const std::vector<std::pair<Words, std::string>> runs = {
      {"info arm.urdf", "r\\x1b[31mX\\x07"},
      {"info arm.urdf", "sl\\x7fide"},
      {"info arm.json", "ha\\nnd"},
      {"info arm.srdf", "r\\x1b"},
      {check, "wa\\xc2\\x9bll\\x7f"},
      {check + " --json", "wa\\u009bll\\u007f"},
      {"audit-robot arm.urdf arm.json", "ha\\nnd"},
      {{"tree", "spheres.json", "-o", "a'\a.tree"}, "a'\\x07.tree"}};
  for (const auto& [arguments, part] : runs) {
    const Outcome outcome = run(arguments);
    EXPECT_LE(outcome.exit_code, 1) << outcome.err;
    EXPECT_TRUE(std::all_of(outcome.out.begin(), outcome.out.end(), [](char c) {
      return c == '\n' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7F);
    })) << outcome.out;
    EXPECT_FALSE(has(outcome.out, "\xc2\x9b"));
    EXPECT_TRUE(has(outcome.out, part));
  }
}

TEST_F(MessagesTest, AreExcerptsOfLongTexts) {
  std::string name;
  for (int i = 0; i < 100000; ++i) name += "\xc3\xb6";
  write("long.yml", "collision_spheres: " + name + "x\n");
  expect_readable("info long.yml", "spherule: ");  // of the file that it names
  const std::string err = run("info long.yml").err;
  EXPECT_LT(err.size(), 5000u);
  EXPECT_TRUE(has(err, "\xc3\xb6 [...] \xc3\xb6"));
}

TEST_F(MessagesTest, WarningsAreOneLineToo) {
  write("cube.urdf", urdf_of("<link name=\"ba&#10;se\">" + kSolid + R"(</link><link name="hand"/>
    <joint name="slide" type="prismatic"><parent link="ba&#10;se"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>)"));
  const Outcome outcome = run("check cube.urdf empty.json path.csv --spheres hand.json");
  EXPECT_EQ(outcome.err,
            "spherule: warning: link ba\\nse has a shape but no spheres: it is not checked\n");
}

// A mesh that is not used may be missing.
TEST_F(MessagesTest, OnlyMeshesOfTheGeometryAreNeeded) {
  const std::string unseen = mesh("visual", "package://gone/hand.dae");
  const std::string unsolid = mesh("collision", "package://gone/hand.dae");
  write("seen.urdf", sliding("r", "", unseen + kSolid));
  write("solid.urdf", sliding("r", "", kSeen + unsolid));
  write("cube.srdf", R"(<robot name="r"><disable_collisions link1="base" link2="hand"/></robot>)");
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"robot ", " -o out --max-error 0.04 --effort 0"},
      {"check ", " empty.json path.csv --max-error 0.04 --effort 0"},
      {"view ", " -o page.html"},
      {"check-srdf ", " cube.srdf"},
      {"audit-robot ", " hand.json"}};
  for (const auto& [command, more] : test::effort(commands, 4)) {
    const std::string gone = ": line 1: link 'hand': <mesh>: package://gone";
    const std::string visual = more + " --geometry visual";
    expect_exit(0, command + "seen.urdf" + more);
    expect_refusal(command + "solid.urdf" + more, "spherule: solid.urdf" + gone);
    expect_exit(0, command + "solid.urdf" + visual);
    expect_refusal(command + "seen.urdf" + visual, "spherule: seen.urdf" + gone);
  }
  expect_refusal("view seen.urdf -o page.html --geometry collision,visual", "package://gone");
  // With spheres that are given no mesh is read at all.
  write("none.urdf", sliding("r", "", unseen + unsolid));
  expect_exit(0, "check none.urdf empty.json path.csv --spheres hand.json");
}

TEST_F(MessagesTest, SpheresOfLinksThatAreNotThereAreRefusedOrLeftOut) {
  const std::string what = "two.json: has spheres of 1 link that the robot has not got: 'ghost'";
  json others;
  for (int i = 0; i < 8; ++i) others["link" + std::to_string(i)] = read_json("hand.json")["hand"];
  write("others.json", others.dump());
  const std::vector<std::string> commands = {"check cube.urdf empty.json path.csv --spheres ",
                                             "view cube.urdf -o page.html ",
                                             "audit-robot cube.urdf "};
  for (const std::string& command : test::effort(commands, 2)) {
    const std::string leave_out = " --ignore-unknown-links";
    expect_refusal(command + "two.json",
                   "spherule: " + what + "; --ignore-unknown-links leaves them out\n");
    EXPECT_EQ(expect_exit(0, command + "two.json" + leave_out).err,
              "spherule: warning: " + what + "; they are left out\n");
    EXPECT_EQ(run(command + "hand.json" + leave_out).err, "");
    // If all are, the file is of another robot.
    expect_refusal(command + "others.json" + leave_out,
                   "spherule: others.json: has spheres of 8 links that the robot has not got: "
                   "'link0', 'link1', 'link2', 'link3', 'link4' and 3 more, and of no other\n");
  }
}

// A pipe that a file names would be waited for without an end; on the command line it is meant.
TEST_F(MessagesTest, OnlyRegularFilesAreReadForNamesInFiles) {
  for (const char* pipe : {"pipe", "pipe.xyz", "pipe.json"}) {
    ASSERT_EQ(::mkfifo((folder_ / pipe).c_str(), 0600), 0);
  }
  const std::string reason = " is not a regular file\n";
  write("side.yml", "collision_spheres: pipe\n");
  expect_refusal("info side.yml", "spherule: side.yml: \"collision_spheres\": pipe:" + reason);
  for (const std::string shape :
       {R"("spheres": {"file": "pipe.json"})", R"("tree": {"file": "pipe"})",
        R"("points": {"file": "pipe.xyz", "radius": 0.1})", R"("mesh": {"file": "pipe"})"}) {
    write("cell.json", scene(R"({"name": "a", )" + shape + "}"));
    expect_refusal("check cube.urdf cell.json path.csv --spheres hand.json", reason);
  }
  write("cell.json", scene("", R"("robot": {"srdf": "pipe"})"));
  expect_refusal("check cube.urdf cell.json path.csv --spheres hand.json",
                 "spherule: pipe:" + reason);
}

// Nothing is written but what is asked for, so that there is nothing to leave behind.
TEST_F(MessagesTest, NoFolderForTemporaryFilesIsNeeded) {
  const Outcome robot = type(
      "TMPDIR=/nonexistent exec spherule robot cube.urdf -o out --max-error 0.04 --effort 0 "
      "--format "
      "urdf --proofs none --postures 5");
  EXPECT_EQ(robot.exit_code, 0) << robot.err;
  write_spheres("spheres.json", {{0.0, 0.0, 0.0, 0.1}});
  const Outcome tree = type(
      "mkdir gone; cd gone; rmdir ../gone; exec spherule tree \"$HOME/spheres.json\" -o x.tree");
  EXPECT_EQ(tree.exit_code, 2);
  EXPECT_EQ(tree.err, "spherule: x.tree: no working directory: No such file or directory\n");
}

}  // namespace
}  // namespace spherule
