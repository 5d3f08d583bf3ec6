// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <chrono>
#include <signal.h>
#include <thread>

namespace spherule {
namespace {

using nlohmann::json;

class OutputTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {40, 20, 10});
  }
  void write_many(int count) {
    std::vector<std::array<double, 4>> many;
    for (int i = 0; i < count; ++i) many.push_back({1.0 * i, 0.5 * (i % 7), 0.0, 1.0});
    write_spheres("many.json", many);
  }
};

TEST_F(OutputTest, FailureLeavesTheOlderFile) {
  write("out.json", "precious");
  write("bad.stl", "solid bad\nfacet normal 0 0 0\nouter loop\nvertex 0 0 nan\n");
  expect_refusals({{"fit bad.stl -o out.json", "bad.stl: "},
                   {"fit missing.stl -o out.json", "missing.stl: "},
                   {"tree missing.json -o out.json", "missing.json: "},
                   {"view missing.json -o out.json", "missing.json: "}});
  EXPECT_EQ(read("out.json"), "precious");
  EXPECT_EQ(files(), (Words{"bad.stl", "box.stl", "out.json"}));
}

TEST_F(OutputTest, PlacesAreCheckedBeforeTheWork) {
  // Fine enough to take minutes, were it begun.
  const Words fit = "fit box.stl --max-error 0.01";
  const auto with = [&](const Words& more) { return joined(fit, more); };
  expect_refusals({{with("-o nowhere/out.json"), "nowhere/out.json: no such folder"},
                   {with("-o out.json --report nowhere/r.json"), "nowhere/r.json: "},
                   {with("-o box.stl"), "box.stl: is named twice"},
                   {with("-o out.json --tree ./out.json"), "out.json: is named twice"}});
  std::filesystem::create_symlink("link.json", folder_ / "link.tree");  // to what is not there yet
  expect_refusal(with("-o link.json --tree link.tree"), "link.tree: is named twice");
  std::filesystem::remove(folder_ / "link.tree");
  expect_refusals({{with("-o ."), "is a folder"},
                   {with("-o /dev/full"), "/dev/full: exists and is not a regular file"},
                   {with({"-o", std::string(256, 'n')}), "the name is too long"}});
  EXPECT_EQ(files(), Words{"box.stl"});
}

TEST_F(OutputTest, ALimitOfFileSizesIsAnError) {
  write("out.tree", "precious");
  write_many(2000);
  const Outcome outcome = type("ulimit -f 8; exec spherule tree many.json -o out.tree");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(outcome.err.starts_with("spherule: out.tree: cannot be written: ")) << outcome.err;
  EXPECT_EQ(read("out.tree"), "precious");
  EXPECT_EQ(files(), (Words{"box.stl", "many.json", "out.tree"}));
}

// At whatever allocation the memory ends, also among those that destructors make.
TEST_F(OutputTest, RunningOutOfMemoryIsAnError) {
  if (test::kSanitized) GTEST_SKIP() << "the address sanitizer needs all of the address space";
  write_many(20000);
  write("out.tree", "precious");
  int megabytes = 8;
  const auto type_limited = [&](const std::string& line) {
    return type("ulimit -v " + std::to_string(1024 * megabytes++) + "; exec spherule " + line);
  };
  // Libraries that are loaded do not always say what they lack.
  while (type_limited("--version").exit_code != 0) continue;
  int refused = 0;
  for (;; ++refused) {
    const Outcome outcome = type_limited("tree many.json -o out.tree");
    if (outcome.exit_code == 0) break;
    ASSERT_EQ(outcome.exit_code, 2) << megabytes << " MB: " << outcome.err;
    EXPECT_EQ(outcome.err, "spherule: out of memory\n");
    EXPECT_EQ(read("out.tree"), "precious");
  }
  EXPECT_GT(refused, 2);
  EXPECT_EQ(files(), (Words{"box.stl", "many.json", "out.tree"}));
}

TEST_F(OutputTest, SuccessReplacesTheOlderFileAndLeavesNothingBeside) {
  write("out.json", "old");
  expect_exit(0, "fit box.stl -o out.json --max-error 12");
  EXPECT_EQ(read_json("out.json").at("format"), "spherule-spheres");
  EXPECT_FALSE(read_json("out.json").contains("interrupted"));
  EXPECT_EQ(files(), (Words{"box.stl", "out.json"}));
}

TEST_F(OutputTest, InterruptionLeavesNoHalfWrittenFile) {
  write("out.json", "precious");
  for (const int milliseconds : {1, 20, 300}) {
    const pid_t process = start("fit box.stl -o out.json --max-error 0.02 --report report.json");
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
    EXPECT_EQ(finish(process).exit_code, -SIGINT);
    EXPECT_EQ(read("out.json"), "precious");
    EXPECT_EQ(files(), (Words{"box.stl", "out.json"}));
  }
}

// Once there is a proved answer, an interruption of the search for a better one does not lose it.
TEST_F(OutputTest, InterruptedSearchWritesWhatIsProved) {
  const Outcome outcome = interrupted(
      "fit box.stl -o out.json --max-error 2 --effort 1000000 --tree out.tree --report report.json",
      SIGINT, "out.json");
  EXPECT_TRUE(has(outcome.err, "spherule: interrupted: "));
  EXPECT_TRUE(has(outcome.out, "(proved)"));
  EXPECT_TRUE(has(outcome.out, "\ninterrupted: the search"));
  EXPECT_EQ(files(), (Words{"box.stl", "out.json", "out.tree", "report.json"}));
  expect_exit(0, "audit box.stl out.json");
  // Who finds the files later is told.
  EXPECT_EQ(read_json("out.json").at("interrupted"), true);
  EXPECT_EQ(read_json("report.json").at("interrupted"), true);
  for (const char* file : {"out.json", "report.json"}) {
    const std::string told = run({"info", file}).out;
    EXPECT_TRUE(has(told, "\ninterrupted: the search"));
  }
}

// As a shell has programs in the background ignore it.
TEST_F(OutputTest, WhatTheParentIgnoresStaysIgnored) {
  const auto before = ::signal(SIGINT, SIG_IGN);
  const pid_t process = start("fit box.stl -o out.json --max-error 2 --seconds 2");
  ::signal(SIGINT, before);
  for (int i = 0; i < 15; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    kill(process, SIGINT);
  }
  const Outcome outcome = finish(process);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(has(outcome.err, "interrupted"));
}

// Interrupted at any moment, a command that writes leaves the old file, or the new one whole.
TEST_F(OutputTest, InterruptionWhileWriting) {
  write_many(4000);
  expect_exit(0, "tree many.json -o out.tree");
  const std::string whole = read("out.tree");
  for (int delay = 0; delay < 60; ++delay) {
    write("out.tree", "old");
    const pid_t process = start("tree many.json -o out.tree");
    std::this_thread::sleep_for(std::chrono::microseconds(1000 * delay));
    kill(process, SIGINT);
    finish(process);
    const std::string left = read("out.tree");
    EXPECT_TRUE(left == "old" || left == whole) << "after " << delay << " ms";
    EXPECT_EQ(files(), (Words{"box.stl", "many.json", "out.tree"}));
  }
}

constexpr const char* kEraseLine = "\r\x1b[K";

class ProgressTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (type("script -qec true /dev/null").exit_code != 0) GTEST_SKIP() << "no pseudo-terminal";
  }

  // A bar is shown there, nothing is printed behind it on its line, and none in a pipe.
  void expect_progress(const std::string& arguments) {
    const std::string text = type("script -qec 'spherule " + arguments + "' /dev/null").out;
    const std::string name = arguments;
    EXPECT_TRUE(has(text, kEraseLine)) << name;
    std::size_t at = 0;
    std::string last;
    while ((at = text.find(kEraseLine, at)) != std::string::npos) {
      at += std::string(kEraseLine).size();
      const std::size_t end = std::min(text.find(kEraseLine, at), text.find('\n', at));
      last = text.substr(at, end == std::string::npos ? std::string::npos : end - at);
      const bool is_bar = last.starts_with("[") || last.ends_with("...");
      const bool is_erased =
          end != std::string::npos && text[end] == '\r' && text.compare(end, 3, kEraseLine, 3) == 0;
      EXPECT_TRUE(!is_bar || is_erased) << name << ": " << last;
    }
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << name;
    EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos) << name;
  }
};

TEST_F(ProgressTest, LongCommandsShowABarOnATerminalOnly) {
  write_box("part.stl", {2, 0.1, 0.1});
  expect_progress("fit part.stl -o part.json --max-error 2 --effort 2");
  if (!test::kSanitized) expect_progress("audit part.stl part.json");
#ifdef SPHERULE_HAS_ROBOT
  write("robot.urdf", R"(<robot name="robot"><link name="hand">)" +
                          box("collision", "0.02 0.001 0.001") + "</link></robot>");
  expect_progress("robot robot.urdf -o . --effort 2");
  if (!test::kSanitized) expect_progress("audit-robot robot.urdf robot.curobo.yml");
#endif
}

#ifdef SPHERULE_HAS_ROBOT
TEST_F(ProgressTest, CheckShowsABarOnATerminalOnly) {
  write("robot.urdf", sliding("robot", "", box("collision", "0.008 0.001 0.001")));
  write("cell.json", scene(""));
  // More than are checked between two updates of the bar.
  std::string path;
  for (int i = 0; i < 600; ++i) path += std::to_string(i * 1e-3) + "\n";
  write("path.csv", path);
  expect_progress("check robot.urdf cell.json path.csv");
  expect_progress("check robot.urdf cell.json path.csv --edges");
  const json report = expect_json(0, "check robot.urdf cell.json path.csv --edges");
  EXPECT_EQ(report.at("motions"), 599);
  EXPECT_EQ(report.at("verdict"), "free");
}
#endif

}  // namespace
}  // namespace spherule
