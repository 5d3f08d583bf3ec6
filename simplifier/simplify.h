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

#include "mesh/triangle_mesh.h"
#include "simplifier/certificate.h"
#include "simplifier/cover.h"
#include "simplifier/external_spheres.h"
#include "simplifier/levels.h"
#include "simplifier/zones.h"
#include "spheretree/sphere_file.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace spherule {

// A stage 2 method from outside of this library, in the place of cover(). It covers S as well as it
// can; what it achieved, the certificate says.
struct Stage2Method {
  // Stands in option_record() as the method: not empty, and none of method_names().
  std::string name;
  std::function<SphereCover(const TriangleMesh&, const ExternalSpheres&, const CoverOptions&)> run =
      {};
};

// The options of simplify().
struct SimplifyOptions {
  // E: how far the result may protrude from the simplified solid; 0 chooses 1 % of the box
  // diagonal.
  double max_error = 0.0;
  // The E of each level of detail to fit above the cover (levels.h), in any order. None may be
  // below `max_error`, which is added where it is not among them; where `max_error` is 0, it
  // becomes the least of them.
  std::vector<double> levels = {};
  // D: diameter of the smallest object to be checked against the model; 0 chooses 4 E, or more
  // where a part is so large that the grid of stage 1 would have too many cells (up to a tenth of
  // the box diagonal; `Simplification::options` has the one that was used).
  double min_external_diameter = 0.0;
  // The closing slack aimed at, as a share of D: ways in that are wider than D (1 + tightness) are
  // not filled (ExternalOptions::tightness). What is proved: ExternalSpheres::closing_slack.
  double tightness = ExternalOptions{}.tightness;
  // t: grow M by this much (chord error of the tessellation, calibration).
  double padding = 0.0;
  // No sphere of the result is smaller than this radius.
  double min_radius = 0.0;
  // Where E and D are smaller.
  std::vector<Zone> zones = {};
  // D is smaller along sharp concave edges too (concave_edges.h).
  bool keep_concave_edges = false;
  CoverMethod method = CoverMethod::kCover;
  // Where it is set, it is run instead of `method`, with the CoverOptions that cover() would get.
  std::optional<Stage2Method> stage2_method = {};
  ExternalPlacement external = ExternalPlacement::kReachable;
  std::size_t external_limit = 100000;  // attempts of the random placement
  double min_internal_diameter = 0.0;   // of the paper's loop; 0 chooses E / 2
  std::uint64_t seed = 1;
  int effort = CoverOptions{}.effort;  // of the covering search
  double seconds = 0.0;                // and its limit in time; 0: none
  bool lower_bound = false;            // CoverOptions::lower_bound
  bool history = false;                // of the paper's loop
  int threads = 0;                     // 0: all; the result does not depend on it
  Progress progress = {};
  std::function<void(std::size_t)> on_proved = {};  // CoverOptions::on_proved, of the cover of E
  std::stop_token stop = {};                        // CoverOptions::stop, of the levels, too
};

// S, as stage 1 of simplify() makes it.
struct SimplifiedSolid {
  ExternalSpheres external;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
};

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

// Fills in E and D where they are 0, for this mesh: 1 % of its box diagonal, and 4 E. Stage 1 may
// choose more than that for D (simplified_solid()).
void complete_lengths(SimplifyOptions& options, const TriangleMesh& mesh);

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

// What was promised and is not proved, as a sentence: that the spheres cover, and, where no least
// radius was requested, that they protrude from the simplified solid by at most E, in a zone by at
// most its own, and the spheres of a level by at most that of the level. Empty where all is proved.
std::string broken_promises(const Simplification& simplification);

// D for a tool that is a union of spheres: the diameter of the smallest. If all of them are free of
// M at a place to which the tool gets from outside, they are external spheres themselves, so that
// it does not meet S either (docs/guarantee.md: it has to get there with room to spare all around,
// 1.74 of ExternalSpheres::grid_step). Throws Error with the subject
// "tool" if there is no sphere, one is not usable, or has the radius 0.
double tool_diameter(std::span<const Sphere> tool);

// The options with which simplify() runs stage 1, for an audit that runs it again. Where E is not
// known (0), D / 4 takes its place: the natural ratio.
ExternalOptions external_options(const SimplifyOptions& options);

// How finely an audit of a cover made with error E must look (CertifyOptions::resolution), for a
// mesh with the given box diagonal: a cover keeps a reserve of a few hundredths of E for the proof.
double proof_resolution(double max_error, double diagonal);

// The names of methods and placements on the command line and in files, the default first, and what
// they name. Error for another name.
std::vector<std::string> method_names();
CoverMethod method_named(const std::string& name);
std::vector<std::string> placement_names();
ExternalPlacement placement_named(const std::string& name);

// Errors of levels as they are written on the command line and in files, "80,40,20", and back.
// Error for a text that is not numbers with commas between them.
std::vector<double> levels_named(const std::string& text);
std::string name_of_levels(std::span<const double> levels);

// The options under their command-line names, for SphereFile::options; `scale` is the one the mesh
// was read with. And back, for an audit: what is absent keeps its default, but "tightness" becomes
// ExternalOptions::kNoTightness, with which files that lack it were made. Throws Error naming the
// option for a bad value. A method that is none of method_names() comes back as the name of a
// stage 2 method that cannot be run: an audit judges spheres of any origin.
std::map<std::string, OptionValue> option_record(const SimplifyOptions& options, double scale);
SimplifyOptions options_from_record(const std::map<std::string, OptionValue>& record);

// The tree over the spheres: through the levels, where some were fitted, else that of build_tree().
SphereTree sphere_tree(const Simplification& simplification);

// Spheres, certificate and options in one, ready for save_spheres().
SphereFile sphere_file(const Simplification& simplification, double scale = 1.0);

}  // namespace spherule
