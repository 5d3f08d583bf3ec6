// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/tally.h"

#include <cstdint>

namespace spherule {

// Each makes at least so many cases from a seed, queries, judges, and counts in the report. Returns
// how many cases it made; a case may be queried in several ways.

// Relative poses of two trees: collides(), collide(), within(), PairCache.
std::uint64_t check_poses(std::uint64_t poses, std::uint64_t seed, SoakReport& report);

// Configurations of robots among sphere trees alone: RobotChecker, single and in batches, with
// every instruction set of this machine.
std::uint64_t check_configurations(std::uint64_t configurations, std::uint64_t seed,
                                   SoakReport& report);

// The bounds of distance().
std::uint64_t check_distances(std::uint64_t distances, std::uint64_t seed, SoakReport& report);

// sweep() of bodies that pass each other closely, and of fast ones through thin walls; against
// brute force in 200 steps, and of every hundredth motion in 10,000.
std::uint64_t check_sweeps(std::uint64_t motions, std::uint64_t seed, SoakReport& report);

// RobotChecker::check_edge(), likewise.
std::uint64_t check_edges(std::uint64_t motions, std::uint64_t seed, SoakReport& report);

// RobotChecker in random scenes: check_config() and check_configs() with every instruction set of
// this machine, which must answer as the canonical tests of all pairs do, one by one; and
// check_edge(), against these at many places.
std::uint64_t check_checker_configurations(std::uint64_t configurations, std::uint64_t seed,
                                           SoakReport& report);
std::uint64_t check_checker_edges(std::uint64_t edges, std::uint64_t seed, SoakReport& report);

}  // namespace spherule
