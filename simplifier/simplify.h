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
#include "io/sphere_file.h"
#include "simplifier/types/simplification.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace spherule {

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

// Stage 1 (section II and Algorithm 1 of the paper that simplify.h names; docs/covering.md).
// Deterministic for an equal mesh and equal options, on any number of threads.
// Throws Error for a mesh that validate() refuses and for options out of range (D must be
// finite and at least 1e-60 unless nothing is placed, padding finite and not negative, the grid not
// finer than the resolution of the coordinates or 2^20 steps, zones usable and their values not
// above D and E, and a smaller D only for the reachable placement).
ExternalSpheres place_external_spheres(const TriangleMesh& mesh, const ExternalOptions& options);

// Stage 2: covers S with spheres that protrude from it by at most E. kPaper is the second loop of
// Algorithm 1 of the paper that simplify.h names; kCover a set cover, greedy at first, then by
// row-weighting local search (Gao, Weise and Li, EJOR 246, 2015); see docs/covering.md. On return
// the union of the spheres contains S: the search ends only with what an octree over S has proved;
// certify() proves it again, by a search of its own.
// Every sphere's radius is at most E plus the distance of its centre, a point of S (up to rounding,
// for which a reserve is kept), to the outside of S, and at most a zone's error plus that distance
// where the sphere reaches into that zone, unless min_radius is larger; where external spheres
// close S by a hair and no point of S is found, a sphere of 0.02 E may stand, and certify() says
// how far it protrudes. Deterministic for equal input and options on any number of threads, unless
// `seconds` is set or a stop is requested. Throws Error for a mesh that validate() refuses, for
// external spheres that stage 1 cannot have made, for options out of range, and for an E too small
// for the rounding of the coordinates.
SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options);

// Levels of detail above the cover `spheres`, for the errors given, all larger than that of the
// cover: the finest first, each made for the one before it. A level is a set cover whose rows are
// the finer spheres: a sphere about c of radius at most E + the clearance of c must hold each finer
// sphere that is its child whole. That has a solution, since a finer sphere is such a sphere
// itself. So every level covers what the cover covers, protrudes from S by at most its E (unless
// min_radius forces more, or the cover itself protrudes by more), and each of its spheres encloses
// its children in exact arithmetic, with the reserve of SphereLevel. Spheres are shrunk to what
// their children need. Uses seed, effort (at most the default where `seconds` is set), min_radius,
// threads and progress of the options. Deterministic. Throws Error for a mesh that validate()
// refuses, spheres that are not usable (external ones that stage 1 cannot have made) and errors
// that check_levels() refuses. Zones do not bind levels above the cover.
std::vector<CoverLevel> fit_levels(const TriangleMesh& mesh, const ExternalSpheres& external,
                                   std::span<const Sphere> spheres,
                                   std::span<const double> max_errors, const CoverOptions& options);

// The errors sorted, the finest first. Throws Error unless they are positive and finite and each is
// at least 1 % larger than the next finer one: below that rounding could decide.
std::vector<double> check_levels(std::span<const double> max_errors);

// The tree over the cover in which the spheres of the levels stand.
LevelTree level_tree(std::span<const Sphere> spheres, std::span<const CoverLevel> levels);

// Certifies any set of spheres against a mesh, ours or not (docs/guarantee.md, G1 and G2).
// Independent of how the spheres were found. Throws Error for a mesh that validate() refuses, for
// spheres that are not usable or reach more than 2^24 times as far from the origin as mesh and S,
// for external spheres that stage 1 cannot have made, and for options out of range; an empty set of
// spheres is certified (as covering nothing).
Certificate certify(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                    const CertifyOptions& options = {});

// The part of a certificate that is stored beside the spheres.
CertificateRecord record(const Certificate& certificate);

// Fills in E and D where they are 0, for this mesh: 1 % of its box diagonal, and 4 E. Stage 1 may
// choose more than that for D (simplified_solid()).
void complete_lengths(SimplifyOptions& options, const TriangleMesh& mesh);

// D for a tool that is a union of spheres: the diameter of the smallest. If all of them are free of
// M at a place to which the tool gets from outside, they are external spheres themselves, so that
// it does not meet S either (docs/guarantee.md: it has to get there with room to spare all around,
// 1.74 of ExternalSpheres::grid_step). Throws Error with the subject
// "tool" if there is no sphere, one is not usable, or has the radius 0.
double tool_diameter(std::span<const Sphere> tool);

// The options with which simplify() runs stage 1, for an audit that runs it again. Where E is not
// known (0), D / 4 takes its place: the natural ratio.
ExternalOptions external_options(const SimplifyOptions& options);

// What was promised and is not proved, as a sentence: that the spheres cover, and, where no least
// radius was requested, that they protrude from the simplified solid by at most E, in a zone by at
// most its own, and the spheres of a level by at most that of the level. Empty where all is proved.
std::string broken_promises(const Simplification& simplification);

// The tree over the spheres: through the levels, where some were fitted, else that of build_tree().
SphereTree sphere_tree(const Simplification& simplification);

// Spheres, certificate and options in one, ready for save_spheres().
SphereFile sphere_file(const Simplification& simplification, double scale = 1.0);

}  // namespace spherule
