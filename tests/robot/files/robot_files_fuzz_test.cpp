// SPDX-License-Identifier: BSD-3-Clause
// Files of which some bytes are wrong: they are read, or refused with an Error, and nothing else.

#include "base/error.h"
#include "robot/files/robot_description.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
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
  if (random.index(3) == 0) return mutated(text, random);
  const std::size_t at = random.index(text.size());
  const std::string_view piece = kPieces[random.index(std::size(kPieces))];
  switch (random.index(4)) {
    case 0:
      return text.insert(at, piece);
    case 1:
      return text.replace(at, std::min(piece.size(), text.size() - at), piece);
    default: {
      constexpr std::string_view kInNumbers = "0123456789.-+eE x";
      const std::size_t digit = text.find_first_of("0123456789", at);
      if (digit != std::string::npos) text[digit] = kInNumbers[random.index(kInNumbers.size())];
      return text;
    }
  }
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

// read_file() reads and judges what is read; both happen often.
template <class ReadFile>
void expect_read_or_refused(const std::function<std::string(Random&)>& text_of,
                            ReadFile read_file) {
  Random random(71);
  const TempDir folder;
  int read = 0;
  int refused = 0;
  for (int i = 0; i < effort(1500, 200); ++i) {
    const std::string text = mutated_urdf(text_of(random), random);
    const std::filesystem::path file = write_anew(folder, "robot.xml", text);
    SCOPED_TRACE(text);
    try {
      read_file(file);
      ++read;
    } catch (const Error& error) {
      ASSERT_EQ(error.subject(), file.string());
      ++refused;
    }
  }
  EXPECT_GT(read, refused / 20);
  EXPECT_GT(refused, read / 20);
}

TEST(RobotFilesFuzz, UrdfIsReadOrRefused) {
  expect_read_or_refused(
      [](Random& random) { return random_urdf(random, 1 + static_cast<int>(random.index(4))); },
      [](const std::filesystem::path& file) { expect_sound(read_urdf(file)); });
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
  expect_read_or_refused([&](Random&) { return valid; },
                         [](const std::filesystem::path& file) {
                           for (const LinkSpheres& link : read_srdf(file).sphere_approximations) {
                             for (const Sphere& sphere : link.spheres) {
                               ASSERT_TRUE(sphere.center.allFinite() && sphere.radius > 0.0);
                             }
                           }
                         });
}

}  // namespace
}  // namespace spherule::test
