// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/help_pages.h"
#include "tests/support/effort.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

namespace spherule {
namespace {

constexpr std::size_t kColumns = 100;

// A robot of one finger with what the examples name.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="robot">
  <link name="base">
    <visual><geometry><box size="0.008 0.001 0.001"/></geometry></visual>
    <collision><geometry><box size="0.008 0.001 0.001"/></geometry></collision>
  </link>
  <link name="hand">
    <visual><geometry><box size="0.008 0.001 0.001"/></geometry></visual>
    <collision><geometry><box size="0.008 0.001 0.001"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>
)";

class HelpTest : public CommandTest {
 protected:
  // A line as a user types it, in the folder, with the built command as `spherule`.
  Outcome type(const std::string& line) {
    std::filesystem::create_directories(folder_ / ".bin");
    std::error_code there;
    std::filesystem::create_symlink(SPHERULE_COMMAND, folder_ / ".bin/spherule", there);
    write(".line",
          "cd '" + folder_.string() + "'\nHOME=$PWD\nPATH=\"$PWD/.bin:$PATH\"\n" + line + "\n");
    const int status = std::system(
        ("sh '" + (folder_ / ".line").string() + "' >'" + (folder_ / ".typed").string() + "' 2>&1")
            .c_str());
    return {.exit_code = WEXITSTATUS(status), .out = read(".typed"), .err = ""};
  }

  // All files that the examples start from.
  void write_files() {
    // Without external spheres what is inside is found by a flood: quick in a bar.
    write_box("part.stl", {2, 0.1, 0.1});
    write_box("tool.stl", {0.1, 0.1, 3});
    write_spheres("tool.json", {{0, 0, 0, 2}});
    write_spheres("others.json", {{1, 0.05, 0.05, 0.9}});
    write("robot.urdf", kRobot);
    write("path.csv", "0.2\n0.3\n");
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "floor", "half_space": {}, "pose": {"position": [0, 0, -1]}}]})");
    for (const char* folder :
         {".zfunc", ".config/fish/completions", ".local/share/bash-completion/completions"}) {
      std::filesystem::create_directories(folder_ / folder);
    }
    ASSERT_EQ(type("spherule tree tool.json -o tool.tree").exit_code, 0);
#ifdef SPHERULE_HAS_ROBOT
    ASSERT_EQ(type("spherule robot robot.urdf -o . --effort 0").exit_code, 0);
#endif
  }
};

TEST_F(HelpTest, EveryCommandTellsExitCodesAndExamples) {
  const auto pages = help_pages([this](const auto& line) { return run(line); });
  EXPECT_GE(pages.size(), 8u);
  for (const auto& [command, text] : pages) {
    EXPECT_NE(text.find("\nExit codes: 0 "), std::string::npos) << command;
    EXPECT_FALSE(examples_in(text).empty()) << command;
    for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), kColumns) << line;
  }
}

TEST_F(HelpTest, ExamplesRun) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write_files();
  std::size_t count = 0;
  for (const auto& [command, text] : help_pages([this](const auto& line) { return run(line); })) {
    for (const std::string& example : examples_in(text)) {
      ++count;
      const Outcome outcome = type(example);
      EXPECT_EQ(outcome.exit_code, 0) << command << ": " << example << "\n" << outcome.out;
    }
  }
  EXPECT_GE(count, 15u);
}

TEST_F(HelpTest, HelpIsACommandToo) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "fit"}).out, run({"fit", "--help"}).out);
  EXPECT_EQ(run({"help", "help"}).out, run({"help", "--help"}).out);
  expect_refusal({"help", "fti"}, "there is no command 'fti'; did you mean fit?");
  expect_refusal({"help", "fit", "fit"}, "there is no command 'fit'");
}

TEST_F(HelpTest, NamesThatMayHaveBeenMeant) {
  write_box("part.stl", {6, 5, 4});
  expect_refusal({"fitt"}, "unknown command: fitt; did you mean fit? (see spherule --help)");
  for (const char* typed : {"ft", "fti", "fot"}) {
    expect_refusal({typed}, std::string(typed) + "; did you mean fit?");
  }
  expect_refusal({"veiw"}, "unknown command: veiw; did you mean view?");
  expect_refusal({"fit", "part.stl", "-o", "out.json", "-x"}, "unexpected option: -x (see");
  expect_refusal({"frobnicate"}, "unknown command: frobnicate (see spherule --help)");
  expect_refusal({"fit", "part.stl", "-o", "out.json", "--max-eror", "1"},
                 "unexpected option: --max-eror; did you mean --max-error? (see spherule fit");
  expect_refusal({"fit", "part.stl", "--max-eror=1"}, "did you mean --max-error?");
  expect_refusal({"fit", "part.stl", "-o", "out.json", "--frobnicate"},
                 "unexpected option: --frobnicate (see");
  expect_refusal({"fit"}, "mesh is required; for instance: spherule fit part.stl -o part.json");
  expect_refusal({"collide", "a.tree"}, "(see spherule collide --help)");
  expect_refusal({}, "a command is required; for instance: spherule fit part.stl");
}

TEST_F(HelpTest, ReportsSayWhatToDoNext) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write_box("a part.stl", {2, 0.1, 0.1});
  write_spheres("others.json", {{1, 0.05, 0.05, 0.9}});
  const Outcome fit = run({"fit", "a part.stl", "-o", "out.json", "--max-error", "2"});
  EXPECT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_NE(fit.out.find("next: spherule view 'a part.stl' out.json -o out.html"),
            std::string::npos)
      << fit.out;
  EXPECT_EQ(type("spherule view 'a part.stl' out.json -o out.html").exit_code, 0);
  const Outcome audit = run({"audit", "a part.stl", "others.json"});
  EXPECT_EQ(audit.exit_code, 1);
  const std::string mend = "spherule audit 'a part.stl' others.json --repair others.mended.json";
  EXPECT_NE(audit.out.find("next: " + mend), std::string::npos) << audit.out;
  EXPECT_EQ(type(mend).exit_code, 0);
  EXPECT_EQ(run({"audit", "a part.stl", "others.json", "--json"}).out.find("next:"),
            std::string::npos);
}

// What is offered is about the same model, in the same unit.
TEST_F(HelpTest, NextStepsRepeatWhatWasGiven) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write_box("part.stl", {2, 0.1, 0.1});
  for (const auto& [option, value] : {std::pair("--scale", "0.1"), std::pair("--weld", "0.001")}) {
    const Outcome fit = run({"fit", "part.stl", "-o", "out.json", "--max-error", "0.2", "--effort",
                             "0", option, value});
    EXPECT_NE(fit.out.find("next: spherule tree out.json"), std::string::npos) << fit.out;
    EXPECT_EQ(fit.out.find("spherule view"), std::string::npos) << fit.out;
  }
  write_spheres("others.json", {{0.1, 0.005, 0.005, 0.09}});
  const Outcome audit =
      run({"audit", "part.stl", "others.json", "--scale", "0.1", "--min-external", "0.08"});
  const std::string mend =
      "spherule audit part.stl others.json --scale 0.1 --min-external 0.08 --repair "
      "others.mended.json";
  EXPECT_NE(audit.out.find("next: " + mend), std::string::npos) << audit.out;
  EXPECT_EQ(audit.out.find("spherule view"), std::string::npos) << audit.out;
  EXPECT_EQ(type(mend).exit_code, 0);
}

}  // namespace
}  // namespace spherule
