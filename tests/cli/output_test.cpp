// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <chrono>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace spherule {
namespace {

using nlohmann::json;

class OutputTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("box.stl", {40, 20, 10});
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
  const auto with = [&](const Words& more) {
    Words all = fit;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
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

// While it lives, this process and those that it starts have a limit of `amount`.
class Limited {
 public:
  Limited(int resource, rlim_t amount) : resource_(resource) {
    EXPECT_EQ(::getrlimit(kind(), &old_), 0);
    struct rlimit limit = old_;
    limit.rlim_cur = amount;
    EXPECT_EQ(::setrlimit(kind(), &limit), 0);
  }
  Limited(const Limited&) = delete;
  Limited& operator=(const Limited&) = delete;
  ~Limited() { EXPECT_EQ(::setrlimit(kind(), &old_), 0); }

 private:
  __rlimit_resource kind() const { return static_cast<__rlimit_resource>(resource_); }

  int resource_;
  struct rlimit old_ = {};
};

TEST_F(OutputTest, ALimitOfFileSizesIsAnError) {
  write("out.tree", "precious");
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 2000; ++i) many.push_back({1.0 * i, 0.0, 0.0, 1.0});
  write_spheres("many.json", many);
  {
    const Limited file_size(RLIMIT_FSIZE, 4096);
    expect_refusal("tree many.json -o out.tree", "out.tree: cannot be written: ");
  }
  EXPECT_EQ(read("out.tree"), "precious");
  EXPECT_EQ(files(), (Words{"box.stl", "many.json", "out.tree"}));
}

// At whatever allocation the memory ends, also among those that destructors make.
TEST_F(OutputTest, RunningOutOfMemoryIsAnError) {
  if (test::kSanitized) GTEST_SKIP() << "the address sanitizer needs all of the address space";
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 20000; ++i) many.push_back({1.0 * i, 0.0, 0.0, 1.0});
  write_spheres("many.json", many);
  constexpr rlim_t kMegabyte = 1U << 20U;
  // Libraries that are loaded do not always say what they lack.
  rlim_t megabytes = 8;
  for (;; ++megabytes) {
    const Limited memory(RLIMIT_AS, megabytes * kMegabyte);
    if (run("--version").exit_code == 0) break;
  }
  int refused = 0;
  for (bool done = false; !done; ++megabytes) {
    write("out.tree", "precious");
    const Limited memory(RLIMIT_AS, megabytes * kMegabyte);
    const Outcome outcome = run("tree many.json -o out.tree");
    done = outcome.exit_code == 0;
    if (done) break;
    ++refused;
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
    const pid_t process = start(
        {"fit", "box.stl", "-o", "out.json", "--max-error", "0.02", "--report", "report.json"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
    EXPECT_EQ(finish(process).exit_code, -SIGINT);
    EXPECT_EQ(read("out.json"), "precious");
    EXPECT_EQ(files(), (Words{"box.stl", "out.json"}));
  }
}

// Once there is a proved answer, an interruption of the search for a better one does not lose it.
TEST_F(OutputTest, InterruptedSearchWritesWhatIsProved) {
  for (int milliseconds = 500;; milliseconds *= 2) {
    ASSERT_LT(milliseconds, 100000);
    const pid_t process = start(
        "fit box.stl -o out.json --max-error 2 --effort 1000000 --tree out.tree --report "
        "report.json");
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGINT);
    const Outcome outcome = finish(process);
    ASSERT_EQ(outcome.exit_code, -SIGINT) << outcome.out << outcome.err;
    if (!exists("out.json")) continue;  // there was no answer yet
    EXPECT_TRUE(has(outcome.err, "spherule: interrupted: "));
    EXPECT_TRUE(has(outcome.out, "(proved)"));
    EXPECT_TRUE(has(outcome.out, "\ninterrupted: the search"));
    break;
  }
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
  std::vector<std::array<double, 4>> many;
  for (int i = 0; i < 4000; ++i) many.push_back({1.0 * i, 0.5 * (i % 7), 0.0, 1.0});
  write_spheres("many.json", many);
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
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0) GTEST_SKIP() << "no pseudo-terminal can be opened";
    close(master);
  }

  // What the command shows on a terminal that is its standard output and standard error.
  std::string shown(const Words& arguments) {
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    EXPECT_GE(master, 0);
    EXPECT_EQ(grantpt(master) + unlockpt(master), 0);
    const std::string terminal = ptsname(master);
    const pid_t process = fork();
    EXPECT_GE(process, 0);
    if (process < 0) {
      close(master);
      return {};
    }
    if (process == 0) {
      const int slave = open(terminal.c_str(), O_RDWR | O_NOCTTY);
      if (slave < 0 || chdir(folder_.c_str()) != 0) _exit(126);
      dup2(slave, STDOUT_FILENO);
      dup2(slave, STDERR_FILENO);
      close(slave);
      close(master);
      std::vector<char*> argv = {const_cast<char*>(SPHERULE_COMMAND)};
      for (const std::string& one : arguments) argv.push_back(const_cast<char*>(one.c_str()));
      argv.push_back(nullptr);
      execv(SPHERULE_COMMAND, argv.data());
      _exit(127);
    }
    std::string text;
    char buffer[4096];
    // The terminal closes with the command: reading then fails.
    for (ssize_t count = 0; (count = read_from(master, buffer)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
    int status = 0;
    EXPECT_EQ(waitpid(process, &status, 0), process);
    EXPECT_TRUE(WIFEXITED(status));
    close(master);
    return text;
  }

  // A bar is shown there, nothing is printed behind it on its line, and none in a pipe.
  void expect_progress(const Words& arguments) {
    const std::string text = shown(arguments);
    const std::string name = arguments.front();
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

 private:
  static ssize_t read_from(int descriptor, char (&buffer)[4096]) {
    return ::read(descriptor, buffer, sizeof buffer);
  }
};

TEST_F(ProgressTest, LongCommandsShowABarOnATerminalOnly) {
  write_box("part.stl", {2, 0.1, 0.1});
  expect_progress("fit part.stl -o part.json --max-error 2 --effort 2");
  if (!test::kSanitized) expect_progress("audit part.stl part.json");
#ifdef SPHERULE_HAS_ROBOT
  write("robot.urdf", R"(<robot name="robot"><link name="hand">
    <collision><geometry><box size="0.02 0.001 0.001"/></geometry></collision></link></robot>)");
  expect_progress("robot robot.urdf -o . --effort 2");
  if (!test::kSanitized) expect_progress("audit-robot robot.urdf robot.curobo.yml");
#endif
}

#ifdef SPHERULE_HAS_ROBOT
TEST_F(ProgressTest, CheckShowsABarOnATerminalOnly) {
  write("robot.urdf", R"(<robot name="robot"><link name="base"/><link name="hand">
    <collision><geometry><box size="0.008 0.001 0.001"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("cell.json", R"({"format": "spherule-scene", "version": 1})");
  // More than are checked between two updates of the bar.
  std::string path;
  for (int i = 0; i < 600; ++i) path += std::to_string(i * 1e-3) + "\n";
  write("path.csv", path);
  expect_progress("check robot.urdf cell.json path.csv");
  expect_progress("check robot.urdf cell.json path.csv --edges");
  const auto report =
      nlohmann::json::parse(run("check robot.urdf cell.json path.csv --edges --json").out);
  EXPECT_EQ(report.at("motions"), 599);
  EXPECT_EQ(report.at("verdict"), "free");
}
#endif

}  // namespace
}  // namespace spherule
