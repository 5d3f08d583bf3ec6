// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

using UsageTest = CommandTest;

TEST_F(UsageTest, HelpAndVersionAreNoFaults) {
  for (const char* command : {"fit", "audit", "tree", "info", "collide", "view"}) {
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Usage:"), std::string::npos);
    EXPECT_EQ(help.err, "");
    EXPECT_NE(run({"--help"}).out.find(command), std::string::npos);
  }
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("spherule 0."));
}

TEST_F(UsageTest, FaultyCommandLinesAreRefused) {
  write_box("box.stl", {1, 1, 1});
  expect_refusal({}, "a command is required");
  expect_refusal({"frobnicate"}, "unknown command: frobnicate");
  expect_refusal({"fit", "-o", "out.json"}, "mesh");
  expect_refusal({"fit", "box.stl", "-o", "out.json", "--max-error", "fast"}, "--max-error");
  expect_refusal({"fit", "box.stl", "-o", "out.json", "--seed", "-1"}, "--seed");
  expect_refusal({"fit", "box.stl", "-o", "out.json", "--threads", "-1"}, "--threads");
  expect_refusal({"fit", "box.stl", "-o", "out.json", "--seed", "1", "--seed", "2"}, "--seed");
  for (const char* length :
       {"--max-error", "--min-external", "--padding", "--min-radius", "--min-internal"}) {
    for (const char* value : {"-1", "nan", "inf", "1e999"}) {
      expect_refusal({"fit", "box.stl", "-o", "out.json", length, value},
                     std::string(length) + ": must be finite");
    }
  }
  expect_refusal({"collide", "a.tree"}, "b");
  EXPECT_EQ(files(), std::vector<std::string>{"box.stl"});
}

TEST_F(UsageTest, MethodsThatAreNotThereAreRefused) {
  write_box("box.stl", {1, 1, 1});
  const auto with_method = [](const std::string& method) {
    return std::vector<std::string>{"fit", "box.stl", "-o", "out.json", "--method", method};
  };
  expect_refusal(with_method("other"), "other");
  EXPECT_EQ(files(), std::vector<std::string>{"box.stl"});
}

}  // namespace
}  // namespace spherule
