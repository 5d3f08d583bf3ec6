// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::test {

// A format that is read or written into, for coverage-guided fuzzing and for the test of its
// corpus.
struct FuzzTarget {
  std::string_view name;
  std::string_view extension;  // of a file of the format, with its dot
  // Reads the file and uses what was read, or writes into it and reads the result. Returns where it
  // was read, and where it was refused with an Error about this file or the robot in it; throws
  // std::logic_error where what was read is not sound, and what else a reader throws.
  void (*read)(const std::filesystem::path& file);
  // Valid inputs from which mutation starts.
  std::vector<std::string> (*seeds)();
  // A dictionary for libFuzzer in tests/fuzz/dictionaries/; empty: none.
  std::string_view dictionary;
  // Makes the file of an input that is only its content. Null: the input is the file.
  std::string (*file_around)(std::string_view content) = nullptr;

  std::string file_of(std::string_view input) const {
    return file_around ? file_around(input) : std::string(input);
  }
};

std::span<const FuzzTarget> fuzz_targets();

// Throws std::out_of_range for an unknown name.
const FuzzTarget& fuzz_target(std::string_view name);

}  // namespace spherule::test
