// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/sphere_formats.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::test {

// Files of the user into which the spheres of a robot are written, as `read` of FuzzTarget: where
// the file could be read before, the result reads back to these spheres; YAML and SRDF (without
// carriage returns alone) do not change when they are written into once more.

// What is written: the links base and arm with spheres, hand without, and three pairs.
const RobotSpheres& spheres_to_keep();

void write_into_yaml(const std::filesystem::path& file);  // cuRobo's and XRDF
void write_into_srdf(const std::filesystem::path& file);
void write_into_urdf(const std::filesystem::path& file);

// Files around a content that is mutated, with checksums that are right: hardly any mutant of a
// whole file comes past a checksum.

// The bytes, and the checksum with which sphere trees and link pairs end.
std::string with_checksum(std::string_view content);
std::string without_checksum(std::string_view file);

// A 3MF package around the text of its model.
std::string threemf_around(std::string_view model);

// A format that is read or written into, for coverage-guided fuzzing and for the test of its
// corpus.
struct FuzzTarget {
  std::string_view name;
  std::string_view extension;  // of a file of the format, with its dot
  // Reads the file and uses what was read, or writes into it and reads the result. Returns where it
  // was read, and where it was refused with an Error about this file or the robot in it; throws
  // std::logic_error where what was read is not sound, and what else a reader throws.
  void (*read)(const std::filesystem::path& file);
  // A dictionary for libFuzzer in tests/fuzz/dictionaries/; empty: none.
  std::string_view dictionary;
  // Makes the file of an input that is only its content. Null: the input is the file.
  std::string (*file_around)(std::string_view content) = nullptr;

  // Small valid inputs from which mutation starts, made anew in every run (seeded).
  std::vector<std::string> seeds() const;
  std::string file_of(std::string_view input) const {
    return file_around ? file_around(input) : std::string(input);
  }
};

std::span<const FuzzTarget> fuzz_targets();

// Throws std::out_of_range for an unknown name.
const FuzzTarget& fuzz_target(std::string_view name);

}  // namespace spherule::test
