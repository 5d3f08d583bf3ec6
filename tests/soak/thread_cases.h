// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/soak_record.h"

#include <cstdint>

namespace spherule {

// What threads may do at the same time, as the headers promise; each answer has to be that of one
// thread alone. Under the thread sanitizer each report of it is a fault, too.

// Queries of two trees, each thread with a cache of its own.
SoakRecord check_shared_trees(std::uint64_t scenes, std::uint64_t seed);
// Configurations and edges of one RobotChecker, in batches over several threads, from several
// threads; meanwhile its RobotScene is edited.
SoakRecord check_shared_checkers(std::uint64_t scenes, std::uint64_t seed);
// Fits side by side, each over several threads, with progress told and one of them stopped.
SoakRecord check_fits_at_once(std::uint64_t fits, std::uint64_t seed);
// Files that several threads write and read at the same time.
SoakRecord check_shared_files(std::uint64_t rounds, std::uint64_t seed);

}  // namespace spherule
