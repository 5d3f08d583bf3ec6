// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scale/tally.h"

#include <cstdint>

namespace spherule {

// Each makes at least so many cases from a seed, queries, judges, and counts in the report.

// Relative poses of two trees: collides(), collide(), within(), PairCache.
void check_poses(std::uint64_t poses, std::uint64_t seed, ScaleReport& report);

// Configurations of robots among sphere trees alone: RobotChecker, single and in batches, with
// every instruction set of this machine.
void check_configurations(std::uint64_t configurations, std::uint64_t seed, ScaleReport& report);

// The bounds of distance().
void check_distances(std::uint64_t distances, std::uint64_t seed, ScaleReport& report);

// sweep() of bodies that pass each other closely, and of fast ones through thin walls; against
// brute force in 200 steps, and of every hundredth motion in 10,000.
void check_sweeps(std::uint64_t motions, std::uint64_t seed, ScaleReport& report);

// RobotChecker::check_edge(), likewise.
void check_edges(std::uint64_t motions, std::uint64_t seed, ScaleReport& report);

// RobotChecker in random scenes: check_config() and check_configs() with every instruction set of
// this machine, which must answer as the canonical tests of all pairs do, one by one; and
// check_edge(), against these at many places.
void check_checker_configurations(std::uint64_t configurations, std::uint64_t seed,
                                  ScaleReport& report);
void check_checker_edges(std::uint64_t edges, std::uint64_t seed, ScaleReport& report);

}  // namespace spherule
