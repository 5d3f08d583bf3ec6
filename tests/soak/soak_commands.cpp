// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_commands.h"

#include "base/error.h"
#include "base/files.h"
#include "tests/soak/soak_inputs.h"
#include "tests/support/child_process.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace spherule {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

const std::vector<SoakCommand>& soak_commands() {
  static const std::vector<SoakCommand> kCommands = {
      {"fit",
       {"fit", "in/bar.stl", "-o", "out/bar.json", "--max-error", "4", "--min-external", "20",
        "--effort", "0", "--report", "out/report.json", "--tree", "out/bar.tree", "--view",
        "out/bar.html"}},
      {"fit with zones",
       {"fit", "in/bar.stl", "-o", "out/bar.json", "--max-error", "4", "--min-external", "20",
        "--effort", "0", "--zones", "in/zones.json", "--tree", "out/bar.tree"},
       CommandPart::kKills},
      {"fit of bodies",
       {"fit", "in/bar.stl", "in/rod.stl", "-o", "out/bars.json", "--max-error", "4",
        "--min-external", "20", "--effort", "0", "--report", "out/report.json", "--view",
        "out/bars.html"},
       CommandPart::kKills},
      {"tree", {"tree", "in/bar.json", "-o", "out/bar.tree"}},
      {"audit --repair",
       {"audit", "in/bar.stl", "in/bar.json", "--repair", "out/bar.json", "--max-error", "6"},
       CommandPart::kKills},
      {"audit-robot --repair",
       {"audit-robot", "in/bars.urdf", "in/bars.yml", "--repair", "out/bars.yml", "--max-error",
        "0.08"},
       CommandPart::kKills},
      {"robot",
       {"robot", "in/bars.urdf", "-o", "out", "--max-error", "0.03", "--postures", "100",
        "--effort", "0", "--format", "urdf,srdf,curobo,xrdf,foam,json,tree,pairs"}},
      {"view", {"view", "in/bar.stl", "in/bar.json", "-o", "out/bar.html"}},
      {"completion", {"completion", "bash", "-o", "out/spherule"}, CommandPart::kKills},
      {"manual", {"manual", "-o", "out"}, CommandPart::kKills},
      {"audit", {"audit", "in/bar.stl", "in/bar.json", "--json"}, CommandPart::kMemory},
      {"collide",
       {"collide", "in/a.tree", "in/b.tree", "--distance", "--json"},
       CommandPart::kMemory},
      {"check",
       {"check", "in/bars.urdf", "in/scene.json", "in/path.csv", "--spheres", "in/bars.yml",
        "--edges", "--json"},
       CommandPart::kMemory}};
  return kCommands;
}

CommandFolder::CommandFolder(fs::path program, const SoakCommand& command)
    : program_(std::move(program)), arguments_(command.arguments) {
  std::string pattern = (fs::temp_directory_path() / "spherule-soak-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw Error(pattern, "cannot be made");
  path_ = pattern;
  fs::create_directories(path_ / kOut);
  write_soak_inputs(path_ / "in");
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

}  // namespace spherule
