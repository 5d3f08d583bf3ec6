// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/workpiece.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spherule {

// A place and a direction for the wire's end, in the workpiece's frame.
struct WireTarget {
  Eigen::Vector3d position;
  Eigen::Vector3d direction;  // unit, into the metal
};

// How far the wire's end is kept off a point of the metal, along the mean of its normals: farther
// in the crotch of a seam, for the nozzle. Metres.
double standoff(const SeamPoint& point);

// Of a seam's lowest point that is welded (see seam_point()), where the nozzle still has room.
inline constexpr double kLowestSeamAngle = 0.35;

// Runs of the torch over the workpiece, each with `length` targets: across the joint along two
// seams, along a pipe, around a pipe's rim; with weave, tilt and tack points. Always the same.
std::vector<std::vector<WireTarget>> make_weld_passes(std::size_t length);

}  // namespace spherule
