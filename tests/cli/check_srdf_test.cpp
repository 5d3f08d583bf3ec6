// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

// A cart that is driven against a block from 0.1 m on.
constexpr const char* kRail = R"(<?xml version="1.0"?>
<robot name="rail">
  <link name="block"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="bare"/>
  <link name="plate"><collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision></link>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="block"/><child link="plate"/>
    <origin xyz="0 2 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="rod" type="prismatic"><parent link="plate"/><child link="bare"/>
    <origin xyz="0 -2 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="drive" type="prismatic"><parent link="bare"/><child link="cart"/>
    <axis xyz="1 0 0"/><limit lower="0.1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";

class CheckSrdfTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("rail.urdf", kRail);
  }

  Outcome judge(const std::string& reason, const std::vector<std::string>& more = {}) {
    write("rail.srdf", R"(<robot name="rail">
<disable_collisions link1="block" link2="cart" reason=")" +
                           reason + R"("/>
<disable_collisions link1="block" link2="plate" reason="Adjacent"/></robot>)");
    std::vector<std::string> line = {"check-srdf", "rail.urdf", "rail.srdf"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
};

TEST_F(CheckSrdfTest, SaysWhatTouchesAndWhere) {
  const Outcome result = judge("Never");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.out.find("1 disabled pair touches, though not meant to:\n"
                            "  block and cart (\"Never\"): lift 0."),
            0U)
      << result.out;
  EXPECT_NE(result.out.find("could be disabled, too (proved never to touch):\n  plate and cart\n"),
            std::string::npos)
      << result.out;
  EXPECT_EQ(judge("User").exit_code, 0);
}

// No time is enough for nothing: what is not proved is not confirmed.
TEST_F(CheckSrdfTest, WhatIsNotProvedIsNotConfirmed) {
  const Outcome result = judge("Never", {"--seconds", "1e-9"});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_NE(result.out.find("neither proved nor touching:\n  block and cart (\"Never\")"),
            std::string::npos)
      << result.out;
  EXPECT_EQ(judge("User", {"--seconds", "1e-9"}).exit_code, 0);
}

TEST_F(CheckSrdfTest, TellsItInJson) {
  const Outcome result = judge("Never", {"--json"});
  EXPECT_EQ(result.exit_code, 1);
  const json found = json::parse(result.out);
  ASSERT_EQ(found["pairs"].size(), 2U);
  EXPECT_EQ(found["pairs"][0]["verdict"], "touches");
  EXPECT_TRUE(found["pairs"][0]["wrong"]);
  EXPECT_LE(found["pairs"][0]["witness"]["drive"], 0.2001);
  EXPECT_EQ(found["pairs"][1]["verdict"], "never");
  EXPECT_EQ(found["could_be_added"], json::parse(R"([["plate", "cart"]])"));
}

TEST_F(CheckSrdfTest, BadInputIsRefused) {
  const Outcome result = run({"check-srdf", "rail.urdf", "rail.urdf"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("rail.urdf: it disables no pair of links"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace spherule
