// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres that cover a mesh, and the proof that they do: the function that most users call. M, |M|,
// S, D, E, t and the guarantees G1 to G9 are defined in docs/guarantee.md. "The paper" is Larkin,
// Short, Pan and van Duin, "Bounding Sphere CAD Model Simplification for Efficient Collision
// Detection in Offline Programming". Lengths are in the unit of the mesh.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto fit = spherule::simplify(tetrahedron, {.max_error = 0.5, .effort = 0});
// assert(fit.certificate.covered && broken_promises(fit).empty());
// const spherule::SphereTree tree = sphere_tree(fit);
// assert(tree.spheres().size() == fit.cover.spheres.size());
// @endcode

#include "geometry/triangle_mesh.h"
#include "simplifier/option_record.h"
#include "simplifier/types/cover.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/simplification.h"
#include "simplifier/types/simplify_options.h"

#include <cstddef>

namespace spherule {

// S, as stage 1 of simplify() makes it.
struct SimplifiedSolid {
  ExternalSpheres external;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
};

// Both stages and the certificate: the function that most users call. The certificate comes from a
// second search, on the spheres returned, whatever the fit found out about them.
// Throws Error for a mesh that validate() refuses and for options out of range.
Simplification simplify(const TriangleMesh& mesh, const SimplifyOptions& options = {});

// Stage 1 as simplify() runs it: the S of these options, by the same choice of E and D where they
// are 0. The grid has at most `max_cells` cells (ExternalOptions::max_cells): with fewer of them a
// D that is chosen, and the step of the grid, may be larger. Throws Error as simplify(), but not
// for the stage 2 method, which is not used here.
SimplifiedSolid simplified_solid(const TriangleMesh& mesh, const SimplifyOptions& options,
                                 std::size_t max_cells = ExternalOptions::kMostCells);

// Stage 2 as simplify() runs it: by the stage 2 method, where there is one, else by `method`. E
// must be filled in. Errors as of cover() or the method; with the subject "method" for one
// without a name of its own or that cannot be run.
SphereCover cover_solid(const TriangleMesh& mesh, const ExternalSpheres& external,
                        const SimplifyOptions& options);

// How finely an audit of a cover made with error E must look (CertifyOptions::resolution), for a
// mesh with the given box diagonal: a cover keeps a reserve of a few hundredths of E for the proof.
double proof_resolution(double max_error, double diagonal);

}  // namespace spherule
