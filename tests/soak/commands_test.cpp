// SPDX-License-Identifier: BSD-3-Clause
// The command is killed while it writes, and runs out of memory: each file is the older or the new
// one, whole. What C libraries take by malloc() does not run out.
#include "base/files.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "tests/soak/scale.h"
#include "tests/support/child_process.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_dir.h"

#include <climits>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <vector>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

// A bar along x and one across it, which slides away.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="bars">
  <link name="block">
    <collision><geometry><box size="0.3 0.02 0.02"/></geometry></collision>
  </link>
  <link name="tool">
    <collision><geometry><box size="0.02 0.1 0.02"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="block"/><child link="tool"/>
    <origin xyz="0.22 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
</robot>
)";

// A call of the command in a folder where `in/` has what it reads, and all that it writes comes
// into `out/`. All small, so that it takes some tenths of a second.
struct Command {
  std::string name;
  std::vector<std::string> arguments;
};

// Each kind of file that the command writes.
const std::vector<Command> kCommands = {
    {"tree", {"tree", "in/bar.json", "-o", "out/bar.tree"}},
    {"view", {"view", "in/bar.stl", "in/bar.json", "-o", "out/bar.html"}},
    {"fit",
     {"fit", "in/bar.stl", "-o", "out/bar.json", "--max-error", "4", "--min-external", "20",
      "--effort", "0", "--report", "out/report.json", "--tree", "out/bar.tree", "--view",
      "out/bar.html"}},
    {"audit --repair",
     {"audit", "in/bar.stl", "in/bar.json", "--repair", "out/bar.json", "--max-error", "6"}},
    {"robot",
     {"robot", "in/bars.urdf", "-o", "out", "--max-error", "0.03", "--postures", "100", "--effort",
      "0", "--format", "urdf,srdf,curobo,xrdf,foam,json,tree,pairs"}},
    {"manual", {"manual", "-o", "out"}}};

constexpr const char* kOld = "older\n";

// As write_file_atomically() names what it has not renamed yet.
bool is_temporary(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with('.') && name.find(".spherule-") != std::string::npos;
}

// Two runs differ in the times that they took, and in no character else.
std::string without_numbers(const std::string& bytes) {
  std::string rest;
  for (const char c : bytes) {
    if (std::string_view("0123456789.e+-").find(c) == std::string_view::npos) rest += c;
  }
  return rest;
}

// A folder for one of them.
class CommandFolder {
 public:
  // Runs it; the first run, which must succeed, tells what is written.
  explicit CommandFolder(const Command& command) : arguments_(command.arguments) {
    fs::create_directories(out_);
    fs::create_directories(folder_.path() / "in");
    write_stl(make_box({40.0, 2.0, 2.0}), folder_.path() / "in/bar.stl");
    SphereFile file;
    for (const double x : {-15.0, -5.0, 5.0}) file.spheres.push_back({{x, 0.0, 0.0}, 6.0});
    file.spheres.push_back({{15.0, 0.0, 0.0}, 5.0});
    save_spheres(file, folder_.path() / "in/bar.json");
    folder_.write("in/bars.urdf", kRobot);
    exit_code_ = wait_for(start());
    EXPECT_TRUE(exit_code_ == 0 || exit_code_ == 1) << read_file(folder_.path() / "messages");
    written_ = files();
  }

  // Starts it with these variables in its environment; wait_for() waits for it.
  pid_t start(const std::vector<std::string>& environment = {}) const {
    return start_process(
        SPHERULE_COMMAND, arguments_,
        {.folder = folder_.path(), .out = "said", .error = "messages", .environment = environment});
  }
  int exit_code() const { return exit_code_; }  // of the first run

  // Of the last one, without warnings.
  std::vector<std::string> messages() const {
    std::istringstream text(read_file(folder_.path() / "messages"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("spherule: warning: ") || line.starts_with("spherule: progress: ")) {
        continue;
      }
      lines.push_back(line);
    }
    return lines;
  }

  // Puts older files where the command writes, and removes all others.
  void put_older_files() const {
    fs::remove_all(out_);
    for (const auto& [name, bytes] : written_) {
      fs::create_directories((out_ / name).parent_path());
      folder_.write("out/" + name, kOld);
    }
  }

  // How many times one of its files is seen while it is being written; ends at `most`.
  int see_writing(pid_t process, int most) const {
    const auto has_ended = [&] {
      siginfo_t info = {};
      return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
             info.si_pid == process;
    };
    int seen = 0;
    while (seen < most && !has_ended()) {
      std::error_code error;
      for (const auto& entry : fs::directory_iterator(out_, error)) {
        seen += is_temporary(entry.path()) ? 1 : 0;
      }
    }
    return seen;
  }

  // How the files are: all old, or all new, or some of each; anything else is a fault.
  struct Files {
    bool has_temporary = false;
    bool has_old = false;
    std::vector<std::string> faults{};
  };
  Files look() const {
    Files result;
    const std::map<std::string, std::string> found = files();
    for (const auto& [name, bytes] : found) {
      const auto expected = written_.find(name);
      if (expected == written_.end()) {
        result.has_temporary = result.has_temporary || is_temporary(name);
        if (!is_temporary(name)) result.faults.push_back(name + " is left");
      } else if (bytes == kOld) {
        result.has_old = true;
      } else if (without_numbers(bytes) != without_numbers(expected->second)) {
        result.faults.push_back(name + " is torn: " + std::to_string(bytes.size()) + " bytes");
      }
    }
    for (const auto& [name, bytes] : written_) {
      if (!found.contains(name)) result.faults.push_back(name + " is gone");
    }
    return result;
  }

 private:
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(out_)) {
      if (entry.is_directory()) continue;
      result[fs::relative(entry.path(), out_).string()] = read_file(entry.path());
    }
    return result;
  }

  TempDir folder_;
  fs::path out_ = folder_.path() / "out";
  std::vector<std::string> arguments_;
  int exit_code_ = 0;
  std::map<std::string, std::string> written_;
};

// Half of the runs at any moment, the others while a file is being written. (The command tries its
// places first, which is writing, too.) A run that is not killed then leaves the new files and
// nothing beside them.
TEST(Commands, KilledOnesLeaveWholeFiles) {
  Random random(seeded(7));
  for (const Command& command : effort(kCommands, 1)) {
    const CommandFolder folder(command);
    folder.put_older_files();
    const auto start = std::chrono::steady_clock::now();
    const pid_t whole = folder.start();
    const int sights = folder.see_writing(whole, INT_MAX);
    wait_for(whole);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    for (int i = 0; i < scaled(command.name == "tree" ? 6 : 1); ++i) {
      SCOPED_TRACE(command.name + ", kill " + std::to_string(i));
      folder.put_older_files();
      const pid_t process = folder.start();
      if (i % 2 == 0) {
        folder.see_writing(process, random.whole(1, std::max(1, sights)));
      } else {
        std::this_thread::sleep_for(random.between(0.0, 1.05) * time);
      }
      kill(process, SIGKILL);
      wait_for(process);
      EXPECT_EQ(folder.look().faults, std::vector<std::string>());
      EXPECT_EQ(wait_for(folder.start()), folder.exit_code());
      const CommandFolder::Files after = folder.look();
      EXPECT_EQ(after.faults, std::vector<std::string>());
      EXPECT_FALSE(after.has_temporary || after.has_old);
    }
  }
}

// Wherever memory ends, the command says so and ends with exit code 2, or does without it.
TEST(Commands, MemoryThatEndsIsToldAndTearsNothing) {
  int told = 0;
  for (const Command& command : {kCommands[0], kCommands[1]}) {
    const CommandFolder folder(command);
    for (int i = 0; i < scaled(8); ++i) {
      const std::string allocation = std::to_string(2300 + 97 * i);
      SCOPED_TRACE(command.name + ", allocation " + allocation);
      folder.put_older_files();
      const int exit_code =
          wait_for(folder.start({std::string("LD_PRELOAD=") + SPHERULE_FAILING_NEW,
                                 "SPHERULE_FAILING_ALLOCATION=" + allocation}));
      const CommandFolder::Files files = folder.look();
      EXPECT_EQ(files.faults, std::vector<std::string>());
      EXPECT_FALSE(files.has_temporary);
      if (exit_code == 2) {
        EXPECT_EQ(folder.messages(), std::vector<std::string>{"spherule: out of memory"});
        ++told;
      } else {
        EXPECT_EQ(exit_code, folder.exit_code());
        EXPECT_FALSE(files.has_old);
      }
    }
  }
  EXPECT_GE(told, 8);
}

}  // namespace
}  // namespace spherule::test
