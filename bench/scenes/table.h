// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

namespace spherule {

inline constexpr double kTableHeight = 0.75;      // of the top's upper face above the floor
inline constexpr double kWorkpieceHeight = 0.16;  // of the pipes' axes above the top

// A weld table in metres, the middle of its top above the origin of the floor: a top with bores,
// legs, three stands that carry the pipes of the workpiece, and a fixture post with a clamp arm on
// the robot's left (the robot stands in the direction of -x and looks along +x).
TriangleMesh make_table();

}  // namespace spherule
