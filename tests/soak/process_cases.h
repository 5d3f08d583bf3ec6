// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/soak_commands.h"
#include "tests/soak/soak_record.h"

#include <cstdint>
#include <filesystem>

namespace spherule {

// Runs a command so many times and kills it (SIGKILL): half of the times at any moment of its run,
// the others shortly after a file that is being written was seen. Then each file is the older or
// the new one, whole, and a run that is not killed leaves the new files and nothing beside them.
// `near` counts the kills that left a temporary file or some new files among older ones.
SoakRecord check_kills(const std::filesystem::path& program, const SoakCommand& command,
                       std::uint64_t kills, std::uint64_t seed);

// Runs a command so many times with `failing_new` loaded: its allocations number first, first +
// step, ... by operator new fail, each in a run of its own. The run says "out of memory" and ends
// with exit code 2, or does without that memory and ends as always; its files are as above. `near`
// counts the former. The record is the last if a run had fewer allocations.
struct FailingAllocations {
  std::uint64_t first;
  std::uint64_t step;
  std::uint64_t runs;
};
SoakRecord check_memory(const std::filesystem::path& program,
                        const std::filesystem::path& failing_new, const SoakCommand& command,
                        const FailingAllocations& failing);

}  // namespace spherule
