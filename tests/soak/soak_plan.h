// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/soak_state.h"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace spherule {

struct SoakChunk {
  std::uint64_t number;
  std::uint64_t cases;
  std::uint64_t seed;  // of its own
  double scale;        // of the soak
};

// One kind of case; a part of the soak has several.
struct SoakQuestion {
  std::string part;
  std::string name;
  std::uint64_t
      cases;  // of the whole soak; 0: chunk after chunk, until one says that it is the last
  std::uint64_t of_chunk;
  std::function<SoakRecord(const SoakChunk&)> run;
};

// What is run. The kills and the memory need the built command, the latter the object that makes
// allocations fail, too; without them these parts have no questions.
struct SoakPrograms {
  std::filesystem::path command{};
  std::filesystem::path failing_new{};
};
std::vector<SoakQuestion> soak_questions(const SoakPrograms& programs);

// Runs the chunks that are not done yet, at most so many. Shows its progress on standard error if
// it takes long. Whether all are done.
bool run_soak(const std::vector<SoakQuestion>& questions, SoakState& state,
              std::uint64_t most_chunks = std::numeric_limits<std::uint64_t>::max());

// One chunk alone.
SoakRecord run_chunk(const SoakQuestion& question, std::uint64_t number,
                     const SoakSettings& settings);

// Prints a table, a row for each question that has records and the sum of each part, and the
// faults. Whether there are none.
bool print_table(const std::vector<SoakQuestion>& questions, const SoakState& state,
                 bool with_seconds, std::FILE* file);

}  // namespace spherule
