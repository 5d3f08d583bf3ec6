// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <string>
#include <vector>

namespace spherule {

// The paper's hollow pipe, in metres: a bore of 40 mm (figure 3) in a wall of 5.9 mm, which makes
// the bore 145 % of the metal's volume (figure 8). Its length is not known.
TriangleMesh make_paper_pipe();
inline constexpr double kPaperBore = 0.040;
// "Voxelised using a 5 mm grid of 5 mm diameter spheres" (section IV.B).
inline constexpr double kPaperVoxel = 0.005;

struct Figure3Row {
  double min_external_diameter = 0.0;
  double reachable = 0.0;  // share of the box that is not covered, by placement
  double random = 0.0;
};
// The pipe's box as D grows from a third to more than the bore.
std::vector<Figure3Row> figure_3();

// Figures 6 to 8: the pipe as spheres are added, for one method.
struct FitCourse {
  std::string method;
  std::vector<CoverHistoryEntry> history;
  std::vector<Sphere> spheres;  // of the end, after inflation
};
// Stage 1 with D = 100 mm, then the paper's loop to E = 1 mm.
FitCourse bounding_course();
// The paper's generic packing of the pipe as it is, to the same E.
FitCourse packing_course();

}  // namespace spherule
