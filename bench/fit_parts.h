// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstddef>
#include <functional>
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

// simplify() and build_tree() for every part of the workload; `done` is told of each. Throws Error
// if a certificate does not hold: nothing measured on a set that does not cover is worth having.
std::vector<FitRecord> fit_parts(Workload& workload,
                                 const std::function<void(const FitRecord&)>& done);

}  // namespace spherule
