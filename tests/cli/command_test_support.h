// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace spherule {

// Words of a command line, also written as one line that is split at its spaces.
struct Words : std::vector<std::string> {
  using vector::vector;
  Words(const char* line);
  Words(const std::string& line) : Words(line.c_str()) {}
  Words(vector words) : vector(std::move(words)) {}
};

Words joined(Words words, const Words& more);

// Whether a text has a part; a failure shows both.
::testing::AssertionResult has(const std::string& text, const std::string& part);

std::vector<std::string> lines_of(const std::string& text);

// The scene that a page of `view` carries, and the numbers of its base64 texts of 32-bit floats.
nlohmann::json scene_of(const std::string& page);
std::vector<float> floats_of(const std::string& text);

// A command line that is refused, and a part of the message.
struct Refusal {
  Words arguments;
  std::string reason;
};

// What a run of the built command left behind, without the lines of progress on standard error. A
// run that a signal ended has exit code -signal.
struct Outcome {
  int exit_code = 0;
  std::string out;
  std::string err;
};

// Tests of the command as a process, in an empty folder of their own that is removed at the end.
class CommandTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // Runs `spherule arguments...` in the folder.
  Outcome run(const Words& arguments);
  // Starts it and returns its process; finish() waits for it.
  pid_t start(const Words& arguments);
  Outcome finish(pid_t process);
  // Interrupts a run by a signal, later and later, until it has written `file`.
  Outcome interrupted(const Words& arguments, int signal, const std::string& file);

  // Runs it and expects the refusal of bad input: exit code 2, nothing on standard output, one line
  // on standard error that holds `reason`.
  void expect_refusal(const Words& arguments, const std::string& reason);
  void expect_refusals(const std::vector<Refusal>& refusals);
  // Runs it and expects its exit code, and a part of what it prints; with --json, what it prints.
  Outcome expect_exit(int exit_code, const Words& arguments);
  void expect_said(int exit_code, const Words& arguments, const std::string& part);
  nlohmann::json expect_json(int exit_code, const Words& arguments);
  // What a line does that a user types in the folder, which is the home there; `spherule` is the
  // built command.
  Outcome type(const std::string& line);

  void write(const std::string& file, const std::string& bytes);
  std::string read(const std::string& file) const;
  nlohmann::json read_json(const std::string& file) const;
  bool exists(const std::string& file) const;
  // Names of all files in the folder, sorted, but those with a dot in front.
  std::vector<std::string> files() const;

  // A closed box from the origin, as text STL.
  void write_box(const std::string& file, const std::array<double, 3>& size);
  // A SPHERES.json as another program would write it: x, y, z, radius a sphere; no options.
  void write_spheres(const std::string& file, const std::vector<std::array<double, 4>>& spheres);

  std::filesystem::path folder_;
  Words environment_;  // of the runs: NAME=VALUE
};

}  // namespace spherule
