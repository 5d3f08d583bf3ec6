// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>

namespace spherule {

enum class TreeMode { kSingle, kBatch };

// Sphere trees, one configuration a call: RobotChecker, which answers as collides() for every
// tested pair would.
std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode);

}  // namespace spherule
