// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/stopwatch.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/search/cover_search.h"
#include "simplifier/stage2/solid_cells.h"
#include "simplifier/types/simplification.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Few spheres that cover S (docs/covering.md): a greedy set cover, mended where it leaks, is the
// first proved answer; then rounds search for a cover of fewer spheres by local search, spread the
// spheres to where they have the most to spare, and prove the result or learn from where it leaks.
// Where that no longer helps, cells and rows become finer, and in a long search spheres are
// perturbed.
class CoverFitter {
 public:
  // Spheres that stand at candidates.
  struct Spheres {
    std::vector<Candidate> places;
    std::vector<Sphere> spheres;

    void append(const Spheres& other) {
      places.insert(places.end(), other.places.begin(), other.places.end());
      spheres.insert(spheres.end(), other.spheres.begin(), other.spheres.end());
    }
  };

  // What the spheres `given` cover need not be covered again. With a `part`, cells, S means what of
  // it lies in these, everywhere below. Throws Error for an E too small for the rounding of the
  // coordinates. The seconds of the options run from here on.
  CoverFitter(const Clearance& clearance, const MeshDistance& distance, const CoverOptions& options,
              std::span<const Sphere> given = {}, std::vector<BoxCell> part = {});

  // Before run(): the cells that the search begins with.
  const SolidCells& divided();

  // The fewest spheres that were proved to cover S, together with those given. The search begins
  // with the spheres `proved`, of which that is known, if there are any.
  Spheres run(Spheres proved = {});

  // After run(): that many spheres at least are in any cover that keeps to E; 0 where it was not
  // requested or is not known.
  std::size_t lower_bound() const { return lower_bound_; }

  // Half diagonal of the smallest cells that are told apart, and edge of the cubes of which each
  // gives one leak at most.
  static double finest(double max_error);
  static double leak_spacing(double max_error);

 private:
  using Columns = CoverProblem::Columns;
  using Points = std::vector<Eigen::Vector3d>;

  // The first proved answer: the spheres `proved`, or new ones.
  void begin(Spheres proved);
  // Has the search begin with the best spheres, which are the first candidates of the problem.
  void start_from_best();
  // One round; true if fewer spheres were proved.
  bool improve();
  // Starts again from the best spheres with cells and rows of the next finer spacing, if that is
  // not too fine; what was proved and learned stays.
  bool refine();
  // Makes the cells of the present spacing.
  void divide();
  // Makes a problem of the cells' rows and the `candidates`.
  void build_problem(const std::vector<Candidate>& candidates);
  // Searches for columns that cover all rows, for the target and for an easier one side by side;
  // true if it finds any. What it found, or came to for the easier one, is left in solution_.
  bool search();
  // Proves solution_, or makes rows of its leaks; keeps it, mended where it leaks, if it is the
  // best.
  void prove_or_learn();
  // Sets lower_bound_, from the rows and candidates known so far.
  void bound();
  // New candidates about the rows that solution_ leaves open, and beside its spheres where it is
  // stuck.
  void widen();
  // With spheres added until nothing leaks.
  Spheres mended(Spheres spheres, SolidCells::Leaks leaks);
  // Keeps the problem from growing for ever.
  void forget();
  // Has the search begin with the rows from this one on.
  void know_from(std::size_t row);

  void learn(CoverProblem& problem, const SolidCells::Leaks& leaks);
  // A sphere about the point itself for each of the rows from this one on that no candidate covers,
  // so that every row can be covered.
  void add_own(CoverProblem& problem, std::size_t row) const;
  // The points of the rows from this one on that no candidate covers.
  static Points uncoverable(const CoverProblem& problem, std::size_t row);
  // Rows at the points, with surroundings of this radius and disc, shares of E and of how much
  // further than E spheres reach there, that can be covered; and candidates grown from the starts
  // and from what those leave out.
  struct Surroundings {
    double radius;
    double disc;
  };
  void add_rows(CoverProblem& problem, const Points& points, const Surroundings& surroundings,
                const Points& starts);

  Spheres spheres_of(const CoverProblem& problem, const Columns& columns) const;
  SolidCells::Leaks leaks_of(const std::vector<Sphere>& spheres);
  void report(double share) const;

  const Clearance& clearance_;
  const MeshDistance& distance_;
  const CoverOptions& options_;
  double error_;             // E
  LocalError local_;         // and where it is smaller
  std::size_t spacing_ = 0;  // the number of the cells' spacing
  std::optional<SolidCells> cells_;
  std::size_t cells_made_ = 0;  // before the proofs halved some
  CoverProblem problem_;
  std::size_t sampled_ = 0;  // rows that stand for cells; the others were learned
  CoverSearch::Rows known_;  // that the search begins with
  Columns solution_;         // the last that was tried
  Spheres best_;             // proved
  CoverGoal goal_;
  std::vector<BoxCell> part_;
  Stopwatch watch_;
  std::vector<Sphere> given_;
  std::size_t lower_bound_ = 0;
  std::uint64_t seeds_used_ = 0;
  int in_vain_ = 0;                  // rounds since the last better answer or finer cells
  std::uint64_t first_entries_ = 0;  // of the problem when its cells were made
};

// Few spheres that each protrude from S by at most E and together enclose every one of some finer
// spheres whole (CoverLevel). Unlike a cover of S this is a set cover and no more,
// so what the search finds needs no proof but that of the enclosures.
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
