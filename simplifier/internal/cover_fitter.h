// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cover.h"
#include "simplifier/internal/clearance.h"
#include "simplifier/internal/cover_problem.h"
#include "simplifier/internal/solid_cells.h"
#include "simplifier/mesh_distance.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// Few balls that cover S (covering.md 4 and 8): greedy set cover with rounds of counterexamples up
// to the first proved answer; then rounds that look for a cover of fewer balls by local search,
// spread the balls to where they have the most to spare, and prove the result or learn from where
// it leaks.
class CoverFitter {
 public:
  CoverFitter(const Clearance& clearance, const MeshDistance& distance,
              const CoverOptions& options);

  // The fewest balls that were proved to cover S.
  std::vector<Sphere> run();

 private:
  using Columns = CoverProblem::Columns;
  using Points = std::vector<Eigen::Vector3d>;

  // How many balls to look for. Lowered by `step` after each proof; raised, and the step halved,
  // where the search fails.
  struct Goal {
    std::size_t target = 0;
    std::size_t proved = 0;  // the fewest balls proved; 0: none yet
    std::size_t step = 1;

    // Half the way to what is proved, below it.
    std::size_t easier() const {
      return proved == 0 ? target : std::max(target, std::min(proved - 1, (target + proved) / 2));
    }
    void raise();
    void reached(std::size_t count, bool first);
  };

  // Looks for columns that cover all rows, for the target and for an easier one side by side.
  // Leaves the better in solution_; false if neither search came to an end.
  bool search();
  // Proves solution_ or makes rows of its leaks.
  void prove_or_learn();
  // New candidates about the rows that solution_ leaves open.
  void widen();
  // solution_ with balls added until nothing leaks.
  std::vector<Sphere> repaired();
  void learn(CoverProblem& problem, const SolidCells::Leaks& leaks);
  // With a ball about each point itself, so that every point can be covered.
  void add_candidates(CoverProblem& problem, const Points& points, const Points& own);

  std::vector<Sphere> balls_of(const CoverProblem& problem, const Columns& columns) const;
  SolidCells::Leaks leaks_of(const std::vector<Sphere>& balls);
  void report(double share) const;

  const Clearance& clearance_;
  const CoverOptions& options_;
  double error_;
  SolidCells cells_;
  CoverProblem problem_;
  Columns solution_;          // the last that was tried
  std::vector<Sphere> best_;  // proved
  Goal goal_;
  std::uint64_t batch_ = 0;
};

}  // namespace spherule::internal
