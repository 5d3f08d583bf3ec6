// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <string>
#include <vector>

namespace spherule {

// Figure 2 of the paper: "Sphere packing (33 spheres, left) and bounding sphere simplification (11
// spheres, right)" of a part with concave sections, at the same error. The paper's part is not
// known; ours is a block with slots that no tool of the diameter D gets into. Metres.
struct Figure2 {
  TriangleMesh part;
  double max_error = 0.0;              // E of all
  double min_external_diameter = 0.0;  // D of the bounding spheres
  struct Fit {
    std::string method;
    std::vector<Sphere> spheres;  // inflated: they hold the part
    // Certified upper bound of their protrusion: over the part, or what stage 1 made of it.
    double protrusion = 0.0;
  };
  std::vector<Fit> fits;  // packing, the paper's loop, ours
};

// Throws Error if a fit is not proved.
Figure2 figure_2();

void print_figure_2(const Figure2& figure);

}  // namespace spherule
