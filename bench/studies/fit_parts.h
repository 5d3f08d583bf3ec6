// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace spherule {

struct FitRecord {
  std::string part;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  double max_error = 0.0;
  double min_external_diameter = 0.0;
  double seconds = 0.0;
  bool covered = false;
};

// A line on standard output.
void print_fit(const FitRecord& fit);

// Throws Error naming the part and its broken_promises(), if there are any: nothing measured on
// such a set is worth having.
void check_promises(const Simplification& fit, const std::string& part);

// Rounds of the search: fewer than by default, since the workpiece is large for its E.
inline constexpr int kFitEffort = 30;

// simplify() and build_tree() for every part of the workload; `done` is told of each. Throws Error
// as check_promises() does.
std::vector<FitRecord> fit_parts(Workload& workload,
                                 const std::function<void(const FitRecord&)>& done,
                                 int effort = kFitEffort);

// A configuration of the first weld, for pictures.
inline constexpr std::size_t kShownConfiguration = 300;

// Parts in their places, in the world's frame, as meshes and as spheres.
struct PlacedParts {
  TriangleMesh mesh;
  std::vector<Sphere> spheres;
};

// The cell in one configuration: robot, torch, workpiece and table, by these names.
std::map<std::string, PlacedParts> place_cell(const Workload& workload,
                                              const ArmPositions& configuration);

// The same for `spherule view`: FOLDER/PART.stl and FOLDER/PART.spheres.json. Throws Error.
void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder);

}  // namespace spherule
