// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What simplify() returns, and what is made of it: the proof in words, a tree, a file. Terms:
// docs/guarantee.md.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::Simplification fit =
//     spherule::simplify(tetrahedron, {.max_error = 0.5, .effort = 0});
// assert(spherule::broken_promises(fit).empty());
// assert(spherule::sphere_file(fit).spheres.size() == fit.cover.spheres.size());
// @endcode

#include "simplifier/types/certificate.h"
#include "simplifier/types/cover.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/levels.h"
#include "simplifier/types/simplify_options.h"

#include <vector>

namespace spherule {

// Wall-clock seconds of the parts.
struct SimplifyTimes {
  double external = 0.0;
  double cover = 0.0;
  double levels = 0.0;
  double certify = 0.0;
};

// What simplify() returns.
struct Simplification {
  ExternalSpheres external;
  SphereCover cover;
  std::vector<CoverLevel> levels;  // coarser than the cover, the finest first
  Certificate certificate;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
  // A stop was requested before the searches were done: what is proved holds, but there may be more
  // spheres than a whole search leaves.
  bool interrupted = false;
  SimplifyTimes times;
};

// S, as stage 1 of simplify() makes it.
struct SimplifiedSolid {
  ExternalSpheres external;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
};

}  // namespace spherule
