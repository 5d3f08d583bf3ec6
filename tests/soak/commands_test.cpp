// SPDX-License-Identifier: BSD-3-Clause
// The command is killed while it writes, and runs out of memory: each file is the older or the new
// one, whole. What C libraries take by malloc() does not run out.
#include "base/error.h"
#include "base/files.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "spheretree/build.h"
#include "spheretree/tree_file.h"
#include "tests/soak/random_scene.h"
#include "tests/soak/scale.h"
#include "tests/support/child_process.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

// A bar along x and one across it, which slides away and turns.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="bars">
  <link name="block">
    <collision><geometry><box size="0.3 0.02 0.02"/></geometry></collision>
  </link>
  <link name="carriage"/>
  <link name="tool">
    <collision><geometry><box size="0.02 0.1 0.02"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="block"/><child link="carriage"/>
    <origin xyz="0.22 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="carriage"/><child link="tool"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";

constexpr const char* kRobotSpheres = R"(collision_spheres:
  block:
    - center: [-0.08, 0.0, 0.0]
      radius: 0.08
    - center: [0.08, 0.0, 0.0]
      radius: 0.09
  tool:
    - center: [0.0, 0.0, 0.0]
      radius: 0.06
)";

constexpr const char* kZones = R"({"format":"spherule-zones","version":1,"zones":[
  {"shape":"ball","center":[20,0,0],"radius":3,"max_error":2}]}
)";

constexpr const char* kScene = R"({"format":"spherule-scene","version":1,"obstacles":[
  {"name":"floor","half_space":{},"pose":{"position":[0,0,-0.2]}},
  {"name":"wall","box":{"size":[0.05,1,1]},"pose":{"position":[0.9,0,0]}}]}
)";

// All small, so that a command takes some tenths of a second.
void write_inputs(const fs::path& folder) {
  fs::create_directories(folder);
  write_stl(make_box({40.0, 2.0, 2.0}), folder / "bar.stl");
  write_stl(make_box({2.0, 2.0, 30.0}), folder / "rod.stl");
  SphereFile file;
  for (const double x : {-15.0, -5.0, 5.0}) file.spheres.push_back({{x, 0.0, 0.0}, 6.0});
  file.spheres.push_back({{15.0, 0.0, 0.0}, 5.0});
  save_spheres(file, folder / "bar.json");
  save_tree(build_tree(file.spheres), folder / "a.tree");
  for (Sphere& sphere : file.spheres) sphere.center.y() += 20.0;
  save_tree(build_tree(file.spheres), folder / "b.tree");
  write_file_atomically(folder / "zones.json", kZones);
  write_file_atomically(folder / "bars.urdf", kRobot);
  write_file_atomically(folder / "bars.yml", kRobotSpheres);
  write_file_atomically(folder / "scene.json", kScene);
  write_file_atomically(folder / "path.csv", "0 0\n0.2 0.5\n0.4 -0.5\n");
}

constexpr const char* kOut = "out";
constexpr const char* kMessages = "messages";
constexpr const char* kOld = "older\n";

// As write_file_atomically() names what it has not renamed yet.
bool is_temporary(const std::string& name) {
  constexpr std::string_view kMark = ".spherule-";
  const std::size_t at = name.rfind(kMark);
  return name.starts_with('.') && at != std::string::npos && at > 0 &&
         name.size() == at + kMark.size() + 6;
}

// Two runs differ in the times that they took, and in no character else.
std::string without_numbers(const std::string& bytes) {
  std::string rest;
  for (const char c : bytes) {
    if (std::string_view("0123456789.e+-").find(c) == std::string_view::npos) rest += c;
  }
  return rest;
}

std::map<std::string, std::string> read_files(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  }
  return files;
}

// A call of the command in a folder where `in/` has what it reads, and all that it writes comes
// into `out/`.
struct Command {
  std::string name;
  std::vector<std::string> arguments;
};

// Each kind of file that the command writes.
const std::vector<Command> kCommands = {
    {"fit",
     {"fit", "in/bar.stl", "-o", "out/bar.json", "--max-error", "4", "--min-external", "20",
      "--effort", "0", "--report", "out/report.json", "--tree", "out/bar.tree", "--view",
      "out/bar.html"}},
    {"fit with zones",
     {"fit", "in/bar.stl", "-o", "out/bar.json", "--max-error", "4", "--min-external", "20",
      "--effort", "0", "--zones", "in/zones.json", "--tree", "out/bar.tree"}},
    {"fit of bodies",
     {"fit", "in/bar.stl", "in/rod.stl", "-o", "out/bars.json", "--max-error", "4",
      "--min-external", "20", "--effort", "0", "--report", "out/report.json", "--view",
      "out/bars.html"}},
    {"tree", {"tree", "in/bar.json", "-o", "out/bar.tree"}},
    {"audit --repair",
     {"audit", "in/bar.stl", "in/bar.json", "--repair", "out/bar.json", "--max-error", "6"}},
    {"audit-robot --repair",
     {"audit-robot", "in/bars.urdf", "in/bars.yml", "--repair", "out/bars.yml", "--max-error",
      "0.08"}},
    {"robot",
     {"robot", "in/bars.urdf", "-o", "out", "--max-error", "0.03", "--postures", "100", "--effort",
      "0", "--format", "urdf,srdf,curobo,xrdf,foam,json,tree,pairs"}},
    {"view", {"view", "in/bar.stl", "in/bar.json", "-o", "out/bar.html"}},
    {"completion", {"completion", "bash", "-o", "out/spherule"}},
    {"manual", {"manual", "-o", "out"}}};

const Command& command(const std::string& name) {
  return *std::ranges::find(kCommands, name, &Command::name);
}

// A folder for one of them, removed at the end.
class CommandFolder {
 public:
  // Runs `program`; the first run, which must succeed, tells what is written.
  CommandFolder(fs::path program, const Command& command);
  ~CommandFolder();
  CommandFolder(const CommandFolder&) = delete;
  CommandFolder& operator=(const CommandFolder&) = delete;

  const fs::path& path() const { return path_; }

  // Starts it with these variables in its environment; wait_for() waits for it. What it prints on
  // standard error is in its messages.
  pid_t start(const std::vector<std::string>& environment = {}) const;
  // Without warnings.
  std::vector<std::string> messages() const;
  int exit_code() const { return exit_code_; }  // of the first run

  // Puts older files where the command writes, and removes all others.
  void put_older_files() const;

  // How the files are: all old, or all new, or some of each; anything else is a fault.
  struct Files {
    bool has_temporary = false;
    bool has_old = false;
    bool has_new = false;
    std::vector<std::string> faults{};
  };
  Files look() const;
  // The same of temporary files alone, quickly.
  bool has_temporary() const;

 private:
  bool is_new(const std::string& name, const std::string& bytes) const;

  fs::path program_, path_;
  std::vector<std::string> arguments_;
  int exit_code_ = 0;
  std::map<std::string, std::string> written_;
};

CommandFolder::CommandFolder(fs::path program, const Command& command)
    : program_(std::move(program)), arguments_(command.arguments) {
  std::string pattern = (fs::temp_directory_path() / "spherule-commands-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw Error(pattern, "cannot be made");
  path_ = pattern;
  fs::create_directories(path_ / kOut);
  write_inputs(path_ / "in");
  exit_code_ = wait_for(start());
  if (exit_code_ < 0 || exit_code_ > 1) {
    const std::string said = read_file(path_ / kMessages);
    fs::remove_all(path_);
    throw Error(command.name, "does not run: " + said);
  }
  written_ = read_files(path_ / kOut);
}

CommandFolder::~CommandFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

pid_t CommandFolder::start(const std::vector<std::string>& environment) const {
  return start_process(
      program_, arguments_,
      {.folder = path_, .out = "said", .error = kMessages, .environment = environment});
}

std::vector<std::string> CommandFolder::messages() const {
  std::istringstream text(read_file(path_ / kMessages));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("spherule: warning: ") || line.starts_with("spherule: progress: ")) {
      continue;
    }
    lines.push_back(line);
  }
  return lines;
}

void CommandFolder::put_older_files() const {
  fs::remove_all(path_ / kOut);
  fs::create_directories(path_ / kOut);
  for (const auto& [name, bytes] : written_) {
    fs::create_directories((path_ / kOut / name).parent_path());
    std::ofstream(path_ / kOut / name, std::ios::binary) << kOld;
  }
}

bool CommandFolder::is_new(const std::string& name, const std::string& bytes) const {
  const std::string& expected = written_.at(name);
  return bytes == expected || without_numbers(bytes) == without_numbers(expected);
}

bool CommandFolder::has_temporary() const {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path_ / kOut, error)) {
    if (is_temporary(entry.path().filename().string())) return true;
  }
  return false;
}

CommandFolder::Files CommandFolder::look() const {
  Files files;
  std::map<std::string, std::string> found = read_files(path_ / kOut);
  for (const auto& [name, bytes] : found) {
    if (written_.contains(name)) {
      if (bytes == kOld) {
        files.has_old = true;
      } else if (is_new(name, bytes)) {
        files.has_new = true;
      } else {
        files.faults.push_back(name + " is torn: " + std::to_string(bytes.size()) + " bytes");
      }
    } else if (is_temporary(fs::path(name).filename().string())) {
      files.has_temporary = true;
    } else {
      files.faults.push_back(name + " is left");
    }
  }
  for (const auto& [name, bytes] : written_) {
    if (!found.contains(name)) files.faults.push_back(name + " is gone");
  }
  return files;
}

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

bool has_ended(pid_t process) {
  siginfo_t info = {};
  return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == process;
}

class Killer {
 public:
  Killer(const CommandFolder& folder, SoakRandom& random) : folder_(folder), random_(random) {
    folder_.put_older_files();
    const auto start = Clock::now();
    const pid_t process = folder_.start();
    while (see_next(process)) ++most_sights_;
    wait_for(process);
    whole_run_ = Clock::now() - start;
  }

  // At any moment of a run.
  void at_any_time(pid_t process) const {
    std::this_thread::sleep_for(random_.between(0.0, 1.05) * whole_run_);
    kill(process, SIGKILL);
  }

  // Once one of its files is being written, a little later. The command tries its places first,
  // which is writing, too.
  void while_writing(pid_t process) const {
    const int sights = random_.whole(1, std::max(1, most_sights_));
    const Seconds later(random_.chance(0.3) ? 0.0 : random_.magnitude(1e-6, 1e-2));
    for (int i = 0; i < sights && see_next(process); ++i) {
    }
    std::this_thread::sleep_for(later);
    kill(process, SIGKILL);
  }

 private:
  // Waits for a temporary file to come after there was none; false if the process ended before.
  bool see_next(pid_t process) const {
    while (folder_.has_temporary()) {
      if (has_ended(process)) return false;
    }
    while (!folder_.has_temporary()) {
      if (has_ended(process)) return false;
    }
    return true;
  }

  const CommandFolder& folder_;
  SoakRandom& random_;
  int most_sights_ = 0;
  Seconds whole_run_{};
};

// Kills (SIGKILL) half of the runs at any moment, the others shortly after a file that is being
// written was seen. A run that is not killed then leaves the new files and nothing beside them.
void expect_whole_files(const Command& command, int kills, SoakRandom& random) {
  const CommandFolder folder(SPHERULE_COMMAND, command);
  const Killer killer(folder, random);
  for (int i = 0; i < kills; ++i) {
    SCOPED_TRACE(command.name + ", kill " + std::to_string(i));
    folder.put_older_files();
    const pid_t process = folder.start();
    i % 2 == 1 ? killer.while_writing(process) : killer.at_any_time(process);
    wait_for(process);
    EXPECT_EQ(folder.look().faults, std::vector<std::string>());
    EXPECT_EQ(wait_for(folder.start()), folder.exit_code());
    const CommandFolder::Files after = folder.look();
    EXPECT_EQ(after.faults, std::vector<std::string>());
    EXPECT_FALSE(after.has_temporary || after.has_old);
  }
}

// At a larger scale, of all kinds.
TEST(Commands, KilledOnesLeaveWholeFiles) {
  SoakRandom random(seeded(7));
  if (scale() == 1) return expect_whole_files(command("tree"), 6, random);
  for (const Command& each : kCommands) expect_whole_files(each, scaled(1), random);
}

// Their options are those that the command has today.
TEST(Commands, Run) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const Command& each : kCommands) {
    EXPECT_NO_THROW(CommandFolder(SPHERULE_COMMAND, each)) << each.name;
  }
}

// What is torn, gone or left is found.
TEST(Commands, FilesThatAreNotWholeAreFaults) {
  const CommandFolder folder(SPHERULE_COMMAND, command("tree"));
  const fs::path file = folder.path() / "out" / "bar.tree";
  const std::string bytes = read_file(file);
  EXPECT_TRUE(folder.look().has_new && folder.look().faults.empty());
  folder.put_older_files();
  EXPECT_TRUE(folder.look().has_old && folder.look().faults.empty());
  std::ofstream(file, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  EXPECT_EQ(folder.look().faults.size(), 1U);
  fs::rename(file, folder.path() / "out" / ".bar.tree.spherule-Ab12Cd");
  EXPECT_TRUE(folder.look().has_temporary && folder.has_temporary());
  EXPECT_EQ(folder.look().faults, std::vector<std::string>{"bar.tree is gone"});
}

// Wherever memory ends, the command says so and ends with exit code 2, or does without it.
TEST(Commands, MemoryThatEndsIsToldAndTearsNothing) {
  int told = 0;
  for (const char* const name : {"tree", "view"}) {
    const CommandFolder folder(SPHERULE_COMMAND, command(name));
    for (int i = 0; i < scaled(8); ++i) {
      const std::string allocation = std::to_string(2300 + 97 * i);
      SCOPED_TRACE(std::string(name) + ", allocation " + allocation);
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
