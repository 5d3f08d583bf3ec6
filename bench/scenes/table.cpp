// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/table.h"

#include "bench/scenes/workpiece.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

namespace spherule {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTopThickness = 0.04;
const Vector2d kTopSize(0.9, 1.2);

// A block with a V on top in which a pipe along y lies, its axis at the origin of z.
TriangleMesh v_stand() {
  // The V's flanks stand at 45 degrees and stay a millimetre off the pipe.
  const double groove = (kPipeRadius + 0.001) * 1.4142;
  const double half = 0.03;
  const Loop outline{{-half, -kWorkpieceHeight},
                     {half, -kWorkpieceHeight},
                     {half, half - groove},
                     {0.0, -groove},
                     {-half, half - groove}};
  return placed(extrude(outline, {}, -0.012, 0.012), profile_xz(), Vector3d::Zero());
}

}  // namespace

TriangleMesh make_table() {
  TriangleMesh mesh =
      shifted(make_plate_with_holes({kTopSize.x(), kTopSize.y(), kTopThickness}, 4, 5, 0.028, 8),
              {0.0, 0.0, kTableHeight - 0.5 * kTopThickness});
  for (const double x : {-0.38, 0.38}) {
    for (const double y : {-0.53, 0.53}) {
      append(mesh, shifted(make_box({0.08, 0.08, kTableHeight - kTopThickness}),
                           {x, y, 0.5 * (kTableHeight - kTopThickness)}));
    }
  }
  for (int pipe = 0; pipe < 3; ++pipe) {
    const Vector3d axis = pipe_axis(pipe);
    Eigen::Matrix3d turn;
    turn << axis.y(), axis.x(), 0.0, -axis.x(), axis.y(), 0.0, 0.0, 0.0, 1.0;
    append(mesh, placed(v_stand(), turn,
                        0.17 * axis + Vector3d(0.0, 0.0, kTableHeight + kWorkpieceHeight)));
  }
  append(mesh, shifted(make_box({0.06, 0.06, 0.75}), {-0.32, 0.58, kTableHeight + 0.375}));
  append(mesh, shifted(make_box({0.05, 0.16, 0.05}), {-0.32, 0.52, kTableHeight + 0.70}));
  append(mesh, shifted(make_cylinder(0.02, 0.12, 12), {-0.32, 0.47, kTableHeight + 0.66}));
  snap(mesh);
  return mesh;
}

}  // namespace spherule
