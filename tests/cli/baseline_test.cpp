// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

using nlohmann::json;

class BaselineTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {40, 20, 10});
  }

  json figures(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "baseline");
    arguments.emplace_back("--json");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return json::parse(outcome.out);
  }
};

TEST_F(BaselineTest, EveryFormatIsReadBack) {
  for (const char* name : {"hull.stl", "hull.obj", "hull.PLY"}) {
    const json hull = figures({"hull", "box.stl", "-o", name});
    EXPECT_EQ(hull.at("conservative"), std::string(name) != "hull.stl");  // that is rounded
    EXPECT_EQ(hull.at("after").at("triangles"), 12);
    EXPECT_NEAR(hull.at("volume_ratio"), 1.0, 1e-9);
    EXPECT_EQ(hull.at("loss").at(0), 0.0);
    const Outcome info = run({"info", name});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("12"), std::string::npos);
  }
}

TEST_F(BaselineTest, HullsOfHullsInExactFormatsDoNotShrink) {
  ASSERT_EQ(run({"baseline", "hull", "box.stl", "-o", "one.obj"}).exit_code, 0);
  const json again = figures({"hull", "one.obj", "-o", "two.ply"});
  EXPECT_GE(again.at("volume_ratio"), 1.0);
}

TEST_F(BaselineTest, PartsGoToOneFileOrToAFolder) {
  const json one = figures({"decompose", "box.stl", "-o", "parts.obj"});
  EXPECT_EQ(one.at("conservative"), false);
  std::filesystem::create_directory(folder_ / "parts");
  const json many = figures({"decompose", "box.stl", "-o", "parts"});
  std::size_t written = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "parts")) {
    EXPECT_EQ(entry.path().extension(), ".obj");
    ++written;
  }
  EXPECT_EQ(many.at("parts"), written);
  EXPECT_EQ(many.at("parts"), one.at("parts"));
}

TEST_F(BaselineTest, DecimationKeepsToItsTarget) {
  const json result = figures({"decimate", "box.stl", "-o", "less.ply", "--triangles", "6"});
  EXPECT_LE(result.at("after").at("triangles"), 12);
  EXPECT_EQ(result.at("before").at("triangles"), 12);
  EXPECT_EQ(
      run({"baseline", "decimate", "box.stl", "-o", "text.obj", "--max-error", "0"}).exit_code, 0);
}

TEST_F(BaselineTest, BadInputIsRefused) {
  expect_refusal({"baseline", "hull", "box.stl", "-o", "hull.xyz"}, "hull.xyz: not a mesh format");
  expect_refusal({"baseline", "hull", "box.stl", "-o", "box.stl"}, "named twice");
  expect_refusal({"baseline", "hull", "none.stl", "-o", "hull.obj"}, "none.stl: no such file");
  expect_refusal({"baseline", "hull", "box.stl", "-o", "no/hull.obj"}, "no such folder");
  expect_refusal({"baseline", "hull", "box.stl", "-o", "a.obj", "--triangles", "3"}, "--triangles");
  expect_refusal({"baseline", "decimate", "box.stl", "-o", "a.obj"}, "--max-error");
  expect_refusal({"baseline", "shrink", "box.stl", "-o", "a.obj"}, "");
  expect_refusal({"baseline"}, "a command is required");
  EXPECT_FALSE(exists("a.obj"));
}

TEST_F(BaselineTest, HelpShowsAnExample) {
  for (const char* method : {"decimate", "hull", "decompose"}) {
    const Outcome help = run({"baseline", method, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find(std::string("spherule baseline ") + method), std::string::npos);
  }
}

}  // namespace
}  // namespace spherule
