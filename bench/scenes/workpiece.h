// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

namespace spherule {

// Three pipes of 40 mm (bore 34 mm) that meet in one joint at 120 degrees, in metres: their axes
// leave the origin in the xy plane, pipe 0 along +x, the next ones counter-clockwise. One closed
// solid of 1,942 triangles, hollow throughout, open at the three ends, mitred along three seams.
inline constexpr double kPipeRadius = 0.020;
inline constexpr double kPipeBoreRadius = 0.017;
inline constexpr double kPipeLength = 0.26;  // from the joint's centre to the end

TriangleMesh make_workpiece();

// Direction of a pipe's axis.
Eigen::Vector3d pipe_axis(int pipe);

// A point of the outer surface with the outward normals of the one or two pipes that meet in it.
struct SeamPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal_a;
  Eigen::Vector3d normal_b;
};

// The seam between pipe `pipe` and the next one, from the crotch (angle 0) to the top of the joint
// (angle pi / 2), where all three seams meet.
SeamPoint seam_point(int pipe, double angle);

// The rim at a pipe's end, by the angle from the horizontal; both normals are the pipe's.
SeamPoint rim_point(int pipe, double angle);

// A pipe's surface at a distance from the centre, by the angle from the horizontal.
SeamPoint pipe_point(int pipe, double distance, double angle);

}  // namespace spherule
