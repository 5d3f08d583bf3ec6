// SPDX-License-Identifier: BSD-3-Clause
// Files of the user that get other spheres and the pairs that they do not ignore yet: everything
// else stays as it is, byte by byte. The texts are styled as the published files are.
#include "base/error.h"
#include "base/files.h"
#include "robot/files/srdf.h"
#include "robot/formats/sphere_formats.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

const std::string kNever = "Never (proved within the limits)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

class KeptFiles : public ::testing::Test {
 protected:
  // What is written for an original; written once more, the result stays as it is.
  std::string kept(SphereFormat format, const std::string& original) {
    const auto write = [&](const std::string& text) {
      write_robot_spheres(spheres_, format, {.original = folder_.write("original", text)},
                          folder_.path() / "kept");
      return read_file(folder_.path() / "kept");
    };
    std::string text = write(original);
    EXPECT_EQ(write(text), text) << "the second time";
    expect_all(text);
    return text;
  }

  // All spheres and pairs can be read.
  void expect_all(const std::string& text) {
    const RobotSpheres read = read_robot_spheres(folder_.write("read", text)).spheres;
    std::set<std::pair<std::string, std::string>> pairs;
    for (const DisabledPair& pair : read.self_collision_ignore) {
      EXPECT_TRUE(pairs.insert(std::minmax(pair.link_a, pair.link_b)).second);
    }
    for (const DisabledPair& pair : spheres_.self_collision_ignore) {
      EXPECT_TRUE(pairs.contains(std::minmax(pair.link_a, pair.link_b))) << text;
    }
    ASSERT_EQ(read.links.size(), spheres_.links.size());
    for (std::size_t i = 0; i < read.links.size(); ++i) {
      EXPECT_EQ(read.links[i].link, spheres_.links[i].link);
      EXPECT_EQ(read.links[i].spheres.size(), spheres_.links[i].spheres.size());
    }
  }

  test::TempDir folder_;
  RobotSpheres spheres_{
      .robot = "arm",
      .links = {{"base", {{{0, 0, 0}, 0.5}}}, {"arm", {{{1, 2, 3}, 0.25}}}, {"hand", {}}},
      .self_collision_ignore = {
          {"base", "arm", "Adjacent"}, {"hand", "base", kNever}, {"arm", "hand", {}}}};
};

const std::string kSpheres =
    "      base:\n        - {center: [0.0, 0.0, 0.0], radius: 0.5}\n"
    "      arm:\n        - {center: [1.0, 2.0, 3.0], radius: 0.25}\n      hand: []\n";

// Beside the geometry that gets the spheres there is another one, and further keys follow both.
TEST_F(KeptFiles, XrdfOfTwoGeometries) {
  const std::string before =
      "format: xrdf\nformat_version: 1.0\ncollision:\n  geometry: auto\n"
      "geometry:\n  auto:\n    spheres:\n";
  const std::string between = "  fine:\n    spheres: {}\nself_collision:\n";
  const std::string after = "  geometry: auto\n";
  const std::string ignored = "  ignore:\n    base: [arm, hand]  # Adjacent: arm; " + kNever +
                              ": hand\n    arm: [hand]  # given: hand\n";
  const std::string expected = before + kSpheres + between + ignored + after;
  EXPECT_EQ(kept(SphereFormat::kXrdf, before + between + "  ignore:\n" + after), expected);
  EXPECT_EQ(kept(SphereFormat::kXrdf, before + between + after), expected);
}

// As cuRobo's first files are: lists in brackets within braces, comments, quotes.
TEST_F(KeptFiles, CuroboInBraces) {
  const std::string original = R"(##
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
      # of the old arm

    # below the spheres
    self_collision_ignore:
      {
        "base": ["arm", "other"],
        "other": ["tool"],
      }
    lock_joints: {"a": 0.04, 'b': !!float 4e-2}
)";
  const std::string spheres = R"(      "base":
        - "center": [9, 9, 9]
          "radius": 9.0
)";
  std::string expected = replaced(original, spheres, kSpheres);
  expected = replaced(expected, R"("hand",)", R"("hand", arm,)");
  expected = replaced(expected, "      {\n", "      {\n        hand: [arm],  # given: arm\n");
  expected =
      replaced(expected, R"(        "base": ["arm", "other"])",
               "        # " + kNever + ": hand\n" + R"(        "base": ["arm", "other", hand])");
  EXPECT_EQ(kept(SphereFormat::kCurobo, original), expected);
}

// As its later files are: everything in blocks.
TEST_F(KeptFiles, CuroboInBlocks) {
  const std::string original =
      "robot_cfg:\n  kinematics:\n    collision_link_names:\n    - base\n    - arm\n"
      "    self_collision_ignore:\n      base:\n      - arm   # mine\n"
      "      other:\n      - base\n    text: |\n      # no comment\n    collision_spheres:\n"
      "      base:\n      - center:\n        - 9.0\n        - 9.0\n        - 9.0\n"
      "        radius: 9.0\n  # end";
  std::string expected = replaced(original,
                                  "      base:\n      - center:\n        - 9.0\n        - 9.0\n"
                                  "        - 9.0\n        radius: 9.0\n",
                                  kSpheres);
  expected = replaced(expected, "# mine\n", "# mine\n      - hand  # " + kNever + "\n");
  expected = replaced(expected, "      - base\n    text",
                      "      - base\n      arm: [hand]  # given: hand\n    text");
  EXPECT_EQ(kept(SphereFormat::kCurobo, original), expected);
}

TEST_F(KeptFiles, CuroboWithoutPairsGetsAPlaceForThem) {
  const std::string lists = "base: [arm, hand]  # Adjacent: arm; " + kNever +
                            ": hand\n      arm: [hand]  # given: hand\n";
  const std::string head = "kinematics:\n    collision_spheres:\n" + kSpheres;
  for (const std::string missing :
       {"", "    self_collision_ignore: # none\n", "    self_collision_ignore:\n"}) {
    const std::string text = kept(SphereFormat::kCurobo, head + missing);
    const std::string key = missing.empty() ? "    self_collision_ignore:\n" : missing;
    const std::string added = key + "      " + lists;
    EXPECT_EQ(text,
              missing.empty() ? replaced(head, "    coll", added + "    coll") : head + added);
  }
  for (const std::string missing : {"{}", "null", "~"}) {
    kept(SphereFormat::kCurobo, head + "    self_collision_ignore: " + missing + "\n");
  }
  kept(SphereFormat::kCurobo,
       head + "    self_collision_ignore: {base: [], arm: , 'hand': ~ , \"b\": null}\n");
}

// A file of spheres alone says nothing of pairs.
TEST_F(KeptFiles, PairsAreNotAddedWhereNothingIsSaidOfSelfCollision) {
  spheres_.self_collision_ignore.clear();
  const std::string original = "collision_spheres:\n  base: []\n# end\n";
  const std::string text = kept(SphereFormat::kCurobo, original);
  spheres_.self_collision_ignore = {{"base", "arm", "Adjacent"}};
  write_robot_spheres(spheres_, SphereFormat::kCurobo,
                      {.original = folder_.write("original", original)}, folder_.path() / "kept");
  EXPECT_EQ(read_file(folder_.path() / "kept"), text);
}

TEST_F(KeptFiles, Xrdf) {
  const std::string original =
      "format: \"xrdf\"\nformat_version: 1.0\n\nmodifiers:\n  - set_base_frame: \"base\"\n\n"
      "collision: \n  geometry: \"auto\"\n\nself_collision: \n  geometry: \"auto\"\n"
      "  ignore: \n    base: \n      - \"arm\"\n      - \"world\"\n    hand: [ 'arm' ] # both\n\n"
      "geometry: \n  auto: \n    spheres: \n      base: \n"
      "      - center: [0.0, 0.0, 0.1]\n        radius: 0.07\n  rest: {}\n";
  std::string expected = replaced(
      original, "      base: \n      - center: [0.0, 0.0, 0.1]\n        radius: 0.07\n", kSpheres);
  expected = replaced(expected, "\"world\"\n", "\"world\"\n      - hand  # " + kNever + "\n");
  EXPECT_EQ(kept(SphereFormat::kXrdf, original), expected);
  // Ends of lines are kept, too.
  const auto with_returns = [](const std::string& text) {
    std::string result;
    for (const char c : text) result.append(c == '\n' ? "\r\n" : std::string(1, c));
    return result;
  };
  EXPECT_EQ(kept(SphereFormat::kXrdf, with_returns(original)), with_returns(expected));
}

// Where changes would need more than lines of their own the file is written anew; nothing is lost
// but its comments.
TEST_F(KeptFiles, StylesThatDoNotTakeLinesAreWrittenAnew) {
  for (const std::string original :
       {"{kinematics: {collision_spheres: {base: []}, self_collision_ignore: {x: [y]}, k: 1}}\n",
        "kinematics:\n  k: *n\n  self_collision_ignore: {x: [y]}\n  collision_spheres: {}\n",
        "kinematics:\n  self_collision_ignore: {\"\\x62ase\": [\"\\x79\"], x: [y]}\n  k: 1\n"
        "  collision_spheres: &s {base: []}\n  again: *s\n"}) {
    const std::string text =
        kept(SphereFormat::kCurobo,
             original.find("*n") == std::string::npos ? original : "n: &n 1\n" + original);
    EXPECT_NE(text.find("k: "), std::string::npos);
    const RobotSpheres read = read_robot_spheres(folder_.path() / "kept").spheres;
    EXPECT_EQ(read.self_collision_ignore.size(),
              original.find("x62") == std::string::npos ? 4u : 5u);
  }
}

// A list that stands at two places is changed at one.
TEST_F(KeptFiles, ListsOfAnAnchorAreToldApart) {
  const std::string text =
      kept(SphereFormat::kCurobo,
           "kinematics:\n  self_collision_ignore:\n    other: &l [x]\n    base: *l\n"
           "  collision_spheres: {}\n");
  EXPECT_NE(text.find("    other:\n    - x\n    base:\n    - x\n    - arm  # Adjacent\n"),
            std::string::npos)
      << text;
}

TEST_F(KeptFiles, Srdf) {
  const std::string spheres = R"(  <link_sphere_approximation link="base">
      <sphere center="0.0 0.0 0.0" radius="0.5"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="arm">
      <sphere center="1.0 2.0 3.0" radius="0.25"/>
  </link_sphere_approximation>
  <link_sphere_approximation link="hand">
      <sphere center="0.0 0.0 0.0" radius="0.0"/>
  </link_sphere_approximation>
)";
  const std::string original = R"(<?xml version='1.0' ?>
<!-- <robot> > -->
<robot   name='arm'
         xmlns:x = "y">
  <group name="all"> <link name="arm"/></group>
  <link_sphere_approximation link="old"><sphere center="0 0 0" radius="9"/></link_sphere_approximation>
    <disable_collisions link1="arm" link2="base" reason="User>" /> <!-- mine -->
    <disable_collisions   link1="x" link2="y"/>

  <property name="a>b" value='"/>'/>
</robot> <!-- end -->
)";
  std::string expected =
      replaced(original,
               "  <link_sphere_approximation link=\"old\"><sphere center=\"0 0 0\" "
               "radius=\"9\"/></link_sphere_approximation>\n",
               spheres);
  const std::string pairs = R"(    <disable_collisions link1="hand" link2="base" reason=")" +
                            kNever +
                            "\"/>\n    <disable_collisions link1=\"arm\" link2=\"hand\"/>\n";
  expected = replaced(expected, "link2=\"y\"/>\n", "link2=\"y\"/>\n" + pairs);
  EXPECT_EQ(kept(SphereFormat::kSrdf, original), expected);
}

TEST_F(KeptFiles, SrdfOfOneLineOrOfNone) {
  for (const std::string original :
       {"<robot name=\"arm\"/>", "<robot name=\"arm\"></robot>",
        "<robot name=\"arm\"><disable_collisions link1=\"arm\" link2=\"base\"/><group name=\"g\"/>"
        "</robot>\n",
        "<robot name=\"arm\">\r\n</robot>\r\n",
        "<robot name=\"arm\"><link_sphere_approximation link=\"x\"><sphere center=\"0 0 0\" "
        "radius=\"1\"/></link_sphere_approximation><!-- kept --><group name=\"g\"/></robot>"}) {
    const std::string text = kept(SphereFormat::kSrdf, original);
    for (const char* const part : {"<!-- kept -->", "<group name=\"g\"/>"}) {
      EXPECT_EQ(text.find(part) == std::string::npos, original.find(part) == std::string::npos);
    }
    EXPECT_EQ(std::count(text.begin(), text.end(), '\r') > 0,
              std::count(original.begin(), original.end(), '\r') > 0);
  }
}

// The parser reads more than what is well-formed; old spheres were kept beside the new ones.
TEST_F(KeptFiles, SrdfThatIsNotWellFormedIsRefused) {
  for (const char* const text :
       {"<robot name=\"arm\">< link_sphere_approximation link=\"old\"><sphere center=\"0 0 0\" "
        "radius=\"9\"/></link_sphere_approximation></robot>",
        "<robot name=\"arm\">< /robot>", "</robot/></r><"}) {
    const auto original = folder_.write("original", text);
    try {
      write_robot_spheres(spheres_, SphereFormat::kSrdf, {.original = original},
                          folder_.path() / "kept");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("XML"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "kept"));
  }
}

// What is attached has places in the file that are switched off, and other links spheres of their
// own. A link that cuRobo was not told of has its spheres replaced where it gets some.
TEST_F(KeptFiles, SpheresThatAreSwitchedOffOrOfOtherLinksStay) {
  const std::string names = "kinematics:\n    collision_link_names: [base, hand, held]\n";
  const std::string old =
      "      base:\n      - {center: [9, 9, 9], radius: 9}\n"
      "      - {center: [0, 0, 1], radius: -10}\n"
      "      held:\n      - {center: [0, 0, 2], radius: -10}\n"
      "      - {center: [0, 0, 3], radius: 0.5}\n"
      "      arm: [{center: [7, 7, 7], radius: 7}, {center: [0, 0, 4], radius: 0}]\n"
      "      hand:\n      - {center: [0, 0, 5], radius: -0.01}\n"
      "      camera: [{center: [0, 0, 6], radius: 6}]\n";
  const std::string expected =
      "      base:\n        - {center: [0.0, 0.0, 0.0], radius: 0.5}\n"
      "        - {center: [0.0, 0.0, 1.0], radius: -10.0}\n"
      "      arm:\n        - {center: [1.0, 2.0, 3.0], radius: 0.25}\n"
      "        - {center: [0.0, 0.0, 4.0], radius: 0.0}\n"
      "      hand:\n        - {center: [0.0, 0.0, 5.0], radius: -0.01}\n"
      "      held:\n        - {center: [0.0, 0.0, 3.0], radius: 0.5}\n"
      "        - {center: [0.0, 0.0, 2.0], radius: -10.0}\n"
      "      camera:\n        - {center: [0.0, 0.0, 6.0], radius: 6.0}\n";
  const auto write = [&](const std::string& text) {
    write_robot_spheres(spheres_, SphereFormat::kCurobo,
                        {.original = folder_.write("original", text)}, folder_.path() / "kept");
    return read_file(folder_.path() / "kept");
  };
  spheres_.self_collision_ignore.clear();
  const std::string place = "    collision_spheres:\n";
  const std::string text = replaced(names, "held]", "held, arm]") + place + expected;
  EXPECT_EQ(write(names + place + old), text);
  EXPECT_EQ(write(text), text) << "the second time";
  folder_.write("spheres.yml", "collision_spheres:\n" + old);
  EXPECT_EQ(write(names + "    collision_spheres: spheres.yml\n"), text) << "in a file beside";
  EXPECT_EQ(write("collision_spheres:\n  old: [{center: [0, 0, x], radius: 1}]\n"),
            write("collision_spheres:\n  base: []\n"))
      << "what cannot be read is replaced";
  const std::string xrdf =
      "format: xrdf\nformat_version: 1.0\ncollision:\n  geometry: auto\n"
      "geometry:\n  auto:\n    spheres:\n";
  const std::string held = "      held:\n        - {center: [0.0, 0.0, 2.0], radius: -10.0}\n";
  write_robot_spheres(spheres_, SphereFormat::kXrdf,
                      {.original = folder_.write("original", xrdf + held)},
                      folder_.path() / "kept");
  EXPECT_EQ(read_file(folder_.path() / "kept"), xrdf + kSpheres + held);
}

TEST_F(KeptFiles, AByteOrderMarkAndTheEndOfTheDocumentStay) {
  spheres_.self_collision_ignore.clear();
  const std::string mark = "\xef\xbb\xbf";
  spheres_.links.pop_back();
  const std::string expected = mark + "collision_spheres:  # mine\n" +
                               "  base:\n    - {center: [0.0, 0.0, 0.0], radius: 0.5}\n"
                               "  arm:\n    - {center: [1.0, 2.0, 3.0], radius: 0.25}\n" +
                               "# below\n...\n# behind\n";
  EXPECT_EQ(kept(SphereFormat::kCurobo,
                 mark + "collision_spheres:  # mine\n  base: []\n# below\n...\n# behind\n"),
            expected);
  const std::string lists =
      "kinematics:\n  collision_spheres: {}\n  self_collision_ignore:\n"
      "    base: [x]\n# below\n...\n";
  spheres_.self_collision_ignore = {{"arm", "tool", {}}};
  EXPECT_TRUE(kept(SphereFormat::kCurobo, lists).ends_with("# below\n...\n"));
}

// Its control characters have to be escaped, which makes it four times as long.
TEST_F(KeptFiles, ANameOfALinkThatIsTooLongForAKeyIsRefused) {
  const std::string name = "held" + std::string(300, '\x06');
  const auto original = folder_.write("original", "collision_spheres:\n  " + name + ": []\n");
  try {
    write_robot_spheres(spheres_, SphereFormat::kCurobo, {.original = original},
                        folder_.path() / "kept");
    ADD_FAILURE() << "was written";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("too long for a key of YAML"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "kept"));
}

// Spheres are written where they are read.
TEST_F(KeptFiles, CuroboWhoseConfigurationIsBesideItsSpheres) {
  spheres_.self_collision_ignore.clear();
  for (const std::string head :
       {"robot_cfg: {collision_spheres: {x: []}}\n", "robot_cfg: {kinematics: }\n"}) {
    const std::string text = kept(SphereFormat::kCurobo, head + "collision_spheres:\n  base: []\n");
    EXPECT_TRUE(text.starts_with(head)) << text;
  }
}

// Somebody wants them to be tested.
TEST_F(KeptFiles, PairsThatAnSrdfEnablesAreNotDisabled) {
  const auto original = folder_.write(
      "original", R"(<robot name="arm"><enable_collisions link1="base" link2="hand"/></robot>)");
  write_robot_spheres(spheres_, SphereFormat::kSrdf, {.original = original},
                      folder_.path() / "kept");
  const std::vector<DisabledPair> pairs = read_srdf(folder_.path() / "kept").disabled_pairs;
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].link_b, "arm");
  EXPECT_EQ(pairs[1].link_b, "hand");
}

}  // namespace
}  // namespace spherule
