// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"

namespace spherule {

// A bent MIG weld torch in the frame of the flange it is mounted on (x out of the flange), in
// metres: adapter with screw holes, shock sensor, body, swan neck in the xz plane, open gas nozzle,
// contact tip and wire. 4,318 triangles, as the torch of the paper has.
TriangleMesh make_torch();

// The end of the wire: z points along the wire, out of the torch; the torch's body lies on the side
// of +x.
Pose flange_from_wire();

}  // namespace spherule
