// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <cstddef>
#include <functional>
#include <random>
#include <span>

namespace spherule::internal {

// How many threads an option requires, of which 0 means all.
std::size_t thread_count(int threads);

// Calls `work(worker, piece)` once for each piece 0, 1, ... piece_count - 1, on up to worker_count
// threads, of which the caller's is worker 0; no two calls share a worker at the same time. Pieces
// are handed out in their order, to whoever is free; no more threads are started than pieces, and
// where the system gives fewer, these do all the work.
//
// If a call throws, no further pieces are handed out; once all threads have ended, the exception of
// the first piece that threw is thrown on: the one that doing the pieces in their order would meet.
void share_work(std::size_t piece_count, std::size_t worker_count,
                const std::function<void(std::size_t worker, std::size_t piece)>& work);

// Draws positions evenly between the limits of the joints that the variables move; turning joints
// without limits get a whole turn. `configuration` has variable_count() numbers.
inline void draw_configuration(const RobotModel& robot, std::mt19937_64& bits,
                               std::span<double> configuration) {
  for (std::size_t i = 0; i < configuration.size(); ++i) {
    const auto joint = static_cast<std::size_t>(robot.variable_joints()[i]);
    const double lower = robot.joints()[joint].lower;
    const double part = static_cast<double>(bits() >> 11) * 0x1p-53;
    configuration[i] = lower + (robot.joints()[joint].upper - lower) * part;
  }
}

}  // namespace spherule::internal
