// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "simplifier/internal/clearance.h"
#include "simplifier/internal/cover_candidates.h"
#include "simplifier/internal/internal_spheres.h"
#include "simplifier/internal/point_grid.h"
#include "simplifier/internal/set_cover.h"
#include "simplifier/internal/solid_cells.h"
#include "simplifier/internal/thread_limit.h"
#include "simplifier/mesh_distance.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::Candidate;

// Shares of E.
constexpr double kSpacing = 0.5;  // half diagonal of the cells that rows stand for
constexpr double kWorkingError =
    0.93;                         // rows are covered with this, so that their surroundings are too
constexpr double kFinest = 0.01;  // smallest cell of the proof
constexpr double kLeakSpacing = 0.15;  // leaks become rows this far apart

constexpr double kCube = 1.5;  // edge of the cubes that rows are sorted into

constexpr std::size_t kMinStarts = 2000;
constexpr std::size_t kMaxStarts = 10000;
constexpr int kRounds = 8;

// Greedy set cover on points of S with rounds of counterexamples, then repair.
class Coverer {
 public:
  Coverer(const Clearance& clearance, const MeshDistance& distance, const CoverOptions& options)
      : clearance_(clearance),
        options_(options),
        error_(options.max_error),
        cells_(clearance, distance, kSpacing * options.max_error) {}

  std::vector<Sphere> run() {
    add_rows(cells_.sample());
    add_candidates(starts());
    std::vector<Sphere> balls;
    std::vector<Vector3d> leaks;
    for (int round = 0; round < kRounds; ++round) {
      balls = solve();
      leaks = leaks_of(balls);
      if (leaks.empty()) return balls;
      add_rows(leaks);
      add_candidates(leaks);
      report(round);
    }
    while (!leaks.empty()) {
      clear_rows();
      add_rows(leaks);
      add_candidates(leaks);
      const std::vector<Sphere> more = solve();
      balls.insert(balls.end(), more.begin(), more.end());
      leaks = leaks_of(balls);
    }
    return balls;
  }

 private:
  // Rows to grow candidates from, evenly picked.
  std::vector<Vector3d> starts() const {
    const std::size_t wanted = std::clamp(rows_.size(), kMinStarts, kMaxStarts);
    std::vector<Vector3d> picked;
    for (std::size_t i = 0; i < wanted; ++i) picked.push_back(rows_[i * rows_.size() / wanted]);
    return picked;
  }

  void clear_rows() {
    rows_.clear();
    for (std::vector<std::uint32_t>& covered : instance_.columns) covered.clear();
  }

  void add_rows(const std::vector<Vector3d>& points) {
    const internal::PointGrid grid(points, kCube * error_);
    const auto first = static_cast<std::uint32_t>(rows_.size());
    rows_.insert(rows_.end(), points.begin(), points.end());
    instance_.row_count = rows_.size();
    tbb::parallel_for(std::size_t{0}, candidates_.size(),
                      [&](std::size_t c) { cover_rows(grid, c, first); });
  }

  void add_candidates(const std::vector<Vector3d>& points) {
    const std::size_t first = candidates_.size();
    const auto grown =
        internal::candidates_from(clearance_, points, error_, options_.seed + batch_++);
    candidates_.insert(candidates_.end(), grown.begin(), grown.end());
    // A ball about the point itself, so that every point of S can be covered.
    for (const Vector3d& p : points) {
      candidates_.push_back({p, std::max(0.0, clearance_(p).lower)});
    }
    instance_.columns.resize(candidates_.size());
    const internal::PointGrid grid(rows_, kCube * error_);
    tbb::parallel_for(first, candidates_.size(), [&](std::size_t c) { cover_rows(grid, c, 0); });
  }

  // Notes which points of the grid, numbered from `first`, candidate c covers.
  void cover_rows(const internal::PointGrid& grid, std::size_t c, std::uint32_t first) {
    // A reserve below the radius that ball_of() will give it.
    const double radius = std::max(options_.min_radius, candidates_[c].clearance + error_) -
                          (1.0 - kWorkingError) * error_;
    std::vector<std::uint32_t>& covered = instance_.columns[c];
    const std::size_t before = covered.size();
    grid.find(candidates_[c].center, radius, covered);
    for (std::size_t i = before; i < covered.size(); ++i) covered[i] += first;
  }

  // The ball that is stored, protruding by E at most.
  Sphere ball_of(const Candidate& c) const {
    const double clearance = clearance_(c.center).lower;
    // A leak's cell may have its centre outside of S by less than kFinest; half of what is taken
    // off covers that, the other half keeps the whole cell in the ball.
    const double allowed =
        clearance >= 0.0 ? add_down(clearance, error_) : error_ * (1.0 - 2.0 * kFinest);
    return {c.center, std::max(options_.min_radius, next_down(allowed))};
  }

  std::vector<Sphere> solve() const {
    std::vector<Sphere> balls;
    for (const std::size_t c : greedy_set_cover(instance_))
      balls.push_back(ball_of(candidates_[c]));
    return balls;
  }

  std::vector<Vector3d> leaks_of(const std::vector<Sphere>& balls) {
    const internal::BallHierarchy hierarchy(balls);
    return cells_.find_leaks({balls, hierarchy}, kFinest * error_, kLeakSpacing * error_);
  }

  void report(int round) const {
    if (options_.progress) {
      options_.progress(static_cast<double>(round + 1) / kRounds, "covering");
    }
  }

  const Clearance& clearance_;
  const CoverOptions& options_;
  double error_;
  internal::SolidCells cells_;
  std::vector<Vector3d> rows_;
  std::vector<Candidate> candidates_;
  SetCoverInstance instance_;  // a column for every candidate
  std::uint64_t batch_ = 0;
};

void check_options(const CoverOptions& options) {
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  if (!(usable(options.max_error) && options.max_error > 0.0)) {
    throw Error("max error", "must be positive and finite");
  }
  if (!usable(options.min_radius)) throw Error("min radius", "must be finite and not negative");
  if (!usable(options.min_internal_diameter)) {
    throw Error("min internal diameter", "must be finite and not negative");
  }
}

}  // namespace

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  check_options(options);
  const internal::ThreadLimit threads(options.threads);
  const Clearance clearance(external);
  if (options.method == CoverMethod::kPaper) {
    return place_internal_spheres(mesh, clearance, options);
  }
  SphereCover result;
  result.spheres = Coverer(clearance, MeshDistance(mesh), options).run();
  return result;
}

}  // namespace spherule
