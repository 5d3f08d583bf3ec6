// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cover.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/local_error.h"
#include "spheretree/level_tree.h"
#include "spheretree/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Few spheres that each protrude from S by at most E and together enclose every one of some finer
// spheres whole (simplifier/levels.h). Unlike a cover of S this is a set cover and no more, so what
// the search finds needs no proof but that of the enclosures.
class LevelFitter {
 public:
  // `options.max_error` is the E of the level. The finer spheres must outlive the fitter.
  LevelFitter(const Clearance& clearance, std::span<const Sphere> finer,
              const CoverOptions& options);

  SphereLevel run();

 private:
  using Columns = CoverProblem::Columns;

  void add_candidates();
  // The places of the finer spheres themselves, where no candidate encloses one.
  void add_own();
  void improve(Columns& solution);
  // Each finer sphere goes to the sphere of the solution that has the most to spare for it.
  std::vector<std::int32_t> parents(const Columns& solution) const;
  // The smallest sphere for the children: their enclosing sphere if it is allowed, else the
  // smallest about the column's place.
  Sphere sphere_for(std::size_t column, const std::vector<Sphere>& children) const;

  const Clearance& clearance_;
  std::span<const Sphere> finer_;
  const CoverOptions& options_;
  double error_;  // E less a reserve for rounding
  LocalError local_;
  CoverProblem problem_;
};

}  // namespace spherule::internal
