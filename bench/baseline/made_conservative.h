// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres of any method, grown until they cover.
//
// @code{.cpp}
// #include <spherule/bench/baseline/made_conservative.h>
// #include <cassert>
//
// const spherule::TriangleMesh bar{{{0, 0, 0}, {1, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}},
//                                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const std::vector<spherule::Sphere> spheres{{{0.25, 0, 0}, 0.2}, {{0.75, 0, 0}, 0.2}};
// const auto grown = spherule::made_conservative(bar, spheres);
// assert(grown.certificate.covered && grown.inflation > 0.05 && grown.inflation < 0.06);
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <span>
#include <vector>

namespace spherule {

// A set of spheres grown until it covers, and what is proved about it.
struct ConservativeSpheres {
  std::vector<Sphere> spheres;  // the same centres in the same order
  double inflation = 0.0;       // of every radius; 0 if the spheres cover as they are
  Certificate certificate;      // of the grown spheres, against |M|
};

// Conservative. Grows every radius by the proved upper bound of the uncovered depth of |M| grown by
// `padding` and the mesh's vertex_error (certify() without external spheres: a hollow whose way in
// is narrower than 1/128 of the box diagonal counts as solid), and by 1/4096 of the diagonal, with
// which the second proof succeeds. Then every point of it is in a sphere: one at distance d from
// the nearest sphere is in that sphere grown by d. The certificate is that of a second search, on
// the spheres returned. Lengths in the unit of the mesh. On at most `threads` threads, 0: all; the
// result is the same. Throws Error if there is no sphere, if one is not usable or cannot grow any
// more, for a mesh that validate() refuses and for a padding out of range.
ConservativeSpheres made_conservative(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                      double padding = 0.0, int threads = 0,
                                      const Progress& progress = {});

}  // namespace spherule
