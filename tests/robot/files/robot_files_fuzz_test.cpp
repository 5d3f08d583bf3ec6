// SPDX-License-Identifier: BSD-3-Clause
// Files of which some bytes are wrong: they are read, or refused with an Error, and nothing else.

#include "base/error.h"
#include "robot/files/srdf.h"
#include "robot/files/urdf.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace spherule::test {
namespace {

// Pieces that a parser may stumble over.
constexpr std::string_view kPieces[] = {"<",          ">",
                                        "/>",         "'",
                                        "\"",         "&",
                                        "&#0;",       "&#xFFFFFFFF;",
                                        "&amp;",      "<!--",
                                        "-->",        "<![CDATA[",
                                        "]]>",        "<?",
                                        "?>",         "<!DOCTYPE a [",
                                        "%n%s",       "1e99999",
                                        "-nan",       "inf",
                                        "0x1p9",      "\xF0",
                                        "\xFF",       "\xC3\xA4",
                                        "\n",         " ",
                                        "</robot>",   "<robot>",
                                        "<link/>",    "<a b=",
                                        "1e-400",     "<joint>",
                                        "name",       "type='fixed'",
                                        "package://", "file:///",
                                        "-",          "1",
                                        ".",          "<mimic joint='"};

std::string mutated_urdf(std::string text, Random& random) {
  for (std::size_t n = 1 + random.index(2); n > 0 && !text.empty(); --n) {
    const std::size_t at = random.index(text.size());
    const std::size_t length = std::min(text.size() - at, 1 + random.index(30));
    switch (random.index(10)) {
      case 0:
        text[at] = static_cast<char>(random.index(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(random.index(text.size()), length));
        break;
      case 3:
        text.resize(at);
        break;
      case 4:
        text.insert(at, kPieces[random.index(std::size(kPieces))]);
        break;
      case 5: {
        const std::string_view piece = kPieces[random.index(std::size(kPieces))];
        text.replace(at, std::min(piece.size(), text.size() - at), piece);
        break;
      }
      default: {
        constexpr std::string_view kInNumbers = "0123456789.-+eE x";
        const std::size_t digit = text.find_first_of("0123456789", at);
        if (digit != std::string::npos) text[digit] = kInNumbers[random.index(kInNumbers.size())];
      }
    }
  }
  return text;
}

// Some file systems flush a file that is written anew, but not a new one.
std::filesystem::path write_anew(const TempDir& folder, const std::string& name,
                                 const std::string& text) {
  std::filesystem::remove(folder.path() / name);
  return folder.write(name, text);
}

void expect_sound(const RobotDescription& robot) {
  ASSERT_EQ(robot.links.size(), robot.model.links().size());
  for (const Joint& joint : robot.model.joints()) {
    ASSERT_TRUE(joint.axis.allFinite());
    ASSERT_TRUE(std::isfinite(joint.multiplier) && std::isfinite(joint.offset));
    ASSERT_LE(joint.lower, joint.upper);
    ASSERT_LT(joint.variable, robot.model.variable_count());
  }
}

TEST(RobotFilesFuzz, UrdfIsReadOrRefused) {
  Random random(71);
  const TempDir folder;
  int read = 0;
  int refused = 0;
  for (int i = 0; i < effort(1500, 200); ++i) {
    const std::string text =
        mutated_urdf(random_urdf(random, 1 + static_cast<int>(random.index(4))), random);
    const std::filesystem::path file = write_anew(folder, "robot.urdf", text);
    SCOPED_TRACE(text);
    try {
      expect_sound(read_urdf(file));
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(error.subject(), file.string());
      ++refused;
    }
  }
  EXPECT_GT(read, refused / 20);
  EXPECT_GT(refused, read / 20);
}

TEST(RobotFilesFuzz, SrdfIsReadOrRefused) {
  const std::string valid = R"(<?xml version="1.0"?> <robot name="arm">
      <group name="both"> <group name="left"/> <joint name="j2"/> </group>
      <group name="left"> <chain base_link="base" tip_link="l1"/> <link name="l2"/> </group>
      <group_state name="home" group="left"> <joint name="j1" value="-0.5"/> </group_state>
      <end_effector name="hand" group="left" parent_link="l1" parent_group="both"/>
      <disable_collisions link1="base" link2="l1" reason="Adjacent"/>
      <link_sphere_approximation link="l1"> <sphere center="0.1 -0.2 3e-1" radius="0.25"/>
      </link_sphere_approximation> </robot>)";
  Random random(72);
  const TempDir folder;
  int read = 0;
  int refused = 0;
  for (int i = 0; i < effort(1500, 200); ++i) {
    const std::string text = mutated_urdf(valid, random);
    const std::filesystem::path file = write_anew(folder, "robot.srdf", text);
    SCOPED_TRACE(text);
    try {
      for (const LinkSpheres& link : read_srdf(file).sphere_approximations) {
        for (const Sphere& sphere : link.spheres) {
          ASSERT_TRUE(sphere.center.allFinite() && sphere.radius > 0.0);
        }
      }
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(error.subject(), file.string());
      ++refused;
    }
  }
  EXPECT_GT(read, refused / 20);
  EXPECT_GT(refused, read / 20);
}

}  // namespace
}  // namespace spherule::test
