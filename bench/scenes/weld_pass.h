// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spherule {

// A place and a direction for the wire's end, in the workpiece's frame.
struct WireTarget {
  Eigen::Vector3d position;
  Eigen::Vector3d direction;  // unit, into the metal
};

// Runs of the torch over the workpiece, each with `length` targets: across the joint along two
// seams, along a pipe, around a pipe's rim; with weave, tilt and tack points. Always the same.
std::vector<std::vector<WireTarget>> make_weld_passes(std::size_t length);

}  // namespace spherule
