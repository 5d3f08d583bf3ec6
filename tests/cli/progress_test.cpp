// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spherule {
namespace {

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
  std::string shown(const std::vector<std::string>& arguments) {
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
  void expect_progress(const std::vector<std::string>& arguments) {
    const std::string text = shown(arguments);
    const std::string name = arguments.front();
    EXPECT_NE(text.find(kEraseLine), std::string::npos) << name;
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
  expect_progress({"fit", "part.stl", "-o", "part.json", "--max-error", "2", "--effort", "2"});
  if (!test::kSanitized) expect_progress({"audit", "part.stl", "part.json"});
#ifdef SPHERULE_HAS_ROBOT
  write("robot.urdf", R"(<robot name="robot"><link name="hand">
    <collision><geometry><box size="0.02 0.001 0.001"/></geometry></collision></link></robot>)");
  expect_progress({"robot", "robot.urdf", "-o", ".", "--effort", "2"});
  if (!test::kSanitized) expect_progress({"audit-robot", "robot.urdf", "robot.curobo.yml"});
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
  expect_progress({"check", "robot.urdf", "cell.json", "path.csv"});
  expect_progress({"check", "robot.urdf", "cell.json", "path.csv", "--edges"});
  const auto json = nlohmann::json::parse(
      run({"check", "robot.urdf", "cell.json", "path.csv", "--edges", "--json"}).out);
  EXPECT_EQ(json.at("motions"), 599);
  EXPECT_EQ(json.at("verdict"), "free");
}
#endif

}  // namespace
}  // namespace spherule
