// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What simplify() returns, and what is made of it: the proof in words, a tree, a file. Terms:
// docs/guarantee.md.
//
// @code{.cpp}
// #include <spherule/simplifier/types/simplification.h>
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

#include "io/sphere_file.h"
#include "simplifier/types/certificate.h"
#include "simplifier/types/cover.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/levels.h"
#include "simplifier/types/simplify_options.h"
#include "spheretree/sphere_tree.h"

#include <string>
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

// What was promised and is not proved, as a sentence: that the spheres cover, and, where no least
// radius was requested, that they protrude from the simplified solid by at most E, in a zone by at
// most its own, and the spheres of a level by at most that of the level. Empty where all is proved.
std::string broken_promises(const Simplification& simplification);

// The tree over the spheres: through the levels, where some were fitted, else that of build_tree().
SphereTree sphere_tree(const Simplification& simplification);

// Spheres, certificate and options in one, ready for save_spheres().
SphereFile sphere_file(const Simplification& simplification, double scale = 1.0);

}  // namespace spherule
