// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::test {

// A format that is read, for coverage-guided fuzzing and for the test of its corpus.
struct FuzzTarget {
  std::string_view name;
  std::string_view extension;  // of a file of the format, with its dot
  // Reads the file and uses what was read. Returns where it was read, and where it was refused with
  // an Error about this file or the robot in it; throws std::logic_error where what was read is not
  // sound, and what else a reader throws.
  void (*read)(const std::filesystem::path& file);
  // Valid files from which mutation starts.
  std::vector<std::string> (*seeds)();
  // A dictionary for libFuzzer in tests/fuzz/dictionaries/; empty: none.
  std::string_view dictionary;
};

std::span<const FuzzTarget> fuzz_targets();

// Throws std::out_of_range for an unknown name.
const FuzzTarget& fuzz_target(std::string_view name);

}  // namespace spherule::test
