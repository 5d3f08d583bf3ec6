// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

// What the paper's table says of a method.
struct PaperRow {
  std::string complexity;
  std::size_t collisions = 0;
  double seconds = 0.0;
};

// A way to represent the work cell, as an engine.
struct Representation {
  std::string method;      // its name in paper.json
  std::string complexity;  // of the workpiece; of everything where everything is simplified
  bool is_conservative = false;
  std::unique_ptr<Checker> checker;
  std::optional<PaperRow> paper = {};
};

// The rows of table I, of a fitted workload: the original meshes first; then the workpiece
// decimated to half, its hull and a convex decomposition, all queried by FCL; packed, voxelised and
// in bounding spheres, by the paper's loop and by ours, against robot and torch as meshes; then all
// in spheres. Packing and voxels stand there as the paper has them and once more so that they
// cover.
std::vector<Representation> make_representations(const Workload& workload);

}  // namespace spherule
