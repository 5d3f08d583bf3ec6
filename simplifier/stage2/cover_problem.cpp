// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_problem.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/weld.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/medial_ascent.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

namespace spherule::internal {
namespace {

constexpr double kSlack = 0.2;  // of E: the sphere may protrude by so much
constexpr double kFactor = 1.4;

}  // namespace

bool touched_by(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                double inside, double max_error) {
  const double way = inside - at.lower;
  if (way <= 0.0) return true;
  return clearance.is_at_least(point + way * at.away, inside - kSlack * max_error);
}

double cap_width_at(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                    double max_error) {
  double width = max_error;
  while (width * kFactor <= kWidestCap * max_error &&
         touched_by(clearance, point, at, inside_radius(width * kFactor, max_error), max_error)) {
    width *= kFactor;
  }
  return width;
}

namespace {

constexpr double kContained = 0.97;
// Of how far a sphere reaches along a plane: those of the best size for an edge, which have a
// clearance of E, stand this share of E apart.
constexpr double kThinning = 0.3;
const double kReachAtEdge = cap_width(1.0, 1.0);

// In each cube, of an edge that grows with the spheres, only the candidate with the largest
// clearance, the first of equals.
std::vector<Candidate> thinned(const std::vector<Candidate>& candidates, double max_error,
                               const LocalError& error) {
  std::map<GradedCube, std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::Vector3d& center = candidates[i].center;
    const double scale = error.scale(center);
    const double reach = cap_width(candidates[i].clearance / max_error, scale) / kReachAtEdge;
    const auto [at, first] =
        best.try_emplace(graded_cube_of(center, kThinning * max_error, reach), i);
    if (!first && candidates[i].clearance > candidates[at->second].clearance) at->second = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& [cube, i] : best) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  std::vector<Candidate> result;
  for (const std::size_t i : kept) result.push_back(candidates[i]);
  return result;
}

// Where on the way from one step to the next, between which the error that is allowed changes, it
// begins to.
Candidate turning_point(const Clearance& clearance, const LocalError& error, const AscentStep& from,
                        const AscentStep& to, double allowed) {
  constexpr int kHalvings = 5;
  Candidate found{from.point, from.clearance};
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2.0;
    const Eigen::Vector3d point = from.point + middle * (to.point - from.point);
    const double d = clearance(point).lower;
    if (d >= 0.0 && error.allowance(point, d) == allowed) {
      low = middle;
      found = {point, d};
    } else {
      high = middle;
    }
  }
  return found;
}

}  // namespace

std::vector<Candidate> candidates_from(const Clearance& clearance,
                                       std::span<const Eigen::Vector3d> points, double max_error,
                                       std::uint64_t seed, const LocalError& local) {
  std::vector<std::vector<Candidate>> each(points.size());
  parallel_for(0, points.size(), [&](std::size_t i) {
    Random random(seed_of(seed, i));
    const double error = max_error * local.scale(points[i]);
    const double depth = random.between(0.2, 1.5) * error;
    const Eigen::Vector3d start = points[i] + depth * clearance(points[i]).away;
    const std::vector<AscentStep> path =
        ascend(clearance, start,
               {.first_step = random.between(0.1, 0.4) * error, .least_step = 0.05 * error});
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (path[k].clearance < 0.0) continue;
      if (k + 1 == path.size()) {
        each[i].push_back({path[k].point, path[k].clearance});
        continue;
      }
      // Against a single contact the clearance grows as fast as the point moves, and where the same
      // error is allowed the next sphere contains this one.
      const AscentStep& next = path[k + 1];
      const double allowed = local.allowance(path[k].point, path[k].clearance);
      const double allowed_next = local.allowance(next.point, std::max(0.0, next.clearance));
      const double inflation = (next.clearance - path[k].clearance) + (allowed_next - allowed);
      if (inflation < kContained * (next.point - path[k].point).norm()) {
        each[i].push_back({path[k].point, path[k].clearance});
      }
      if (allowed_next != allowed) {
        each[i].push_back(turning_point(clearance, local, path[k], next, allowed));
      }
    }
  });
  std::vector<Candidate> all;
  for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
  return thinned(all, max_error, local);
}

namespace {

// Shares of E.
constexpr double kCube = 1.5;            // edge of the cubes that rows are sorted into
constexpr double kPinchRadius = 0.02;    // of a sphere where no point of S is known
constexpr double kSheetReserve = 0.005;  // off the radius where S is as thin as the mesh

}  // namespace

CoverProblem::CoverProblem(double max_error, double min_radius, std::span<const Zone> zones)
    : max_error_(max_error), min_radius_(min_radius), error_(max_error, zones) {}

double CoverProblem::radius(const Candidate& candidate) const {
  const double clearance = std::max(0.0, candidate.clearance);
  const double allowed = error_.allowance(candidate.center, clearance);
  return std::max(min_radius_,
                  candidate.clearance >= 0.0 ? clearance + allowed : kPinchRadius * allowed);
}

Sphere CoverProblem::sphere(std::size_t column, const Clearance& clearance) const {
  const Candidate& at = candidates_[column];
  const double exact = clearance(at.center).lower;
  const double error = error_.allowance(at.center, std::max(0.0, exact));
  const double allowed = at.clearance < 0.0 ? radius(at)
                         : exact < 0.0      ? error * (1.0 - kSheetReserve)
                                            : next_down(add_down(exact, error));
  return {at.center, std::max(min_radius_, allowed)};
}

Eigen::Vector3d CoverProblem::Row::furthest_from(const Eigen::Vector3d& other) const {
  if (disc == 0.0) return point;
  const Eigen::Vector3d to_point = point - other;
  const Eigen::Vector3d along = to_point - to_point.dot(normal) * normal;
  const double length = along.norm();
  // What is left of a vector along the normal is rounding, of any direction.
  return length > 1e-9 * to_point.norm() ? Eigen::Vector3d(point + disc / length * along)
                                         : Eigen::Vector3d(point + disc * normal.unitOrthogonal());
}

void CoverProblem::add_rows(std::span<const Row> rows) {
  const std::size_t first = rows_.size();
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  instance_.row_count = rows_.size();
  cover_rows(0, first);
}

void CoverProblem::add_candidates(std::span<const Candidate> candidates) {
  const std::size_t first = candidates_.size();
  candidates_.insert(candidates_.end(), candidates.begin(), candidates.end());
  instance_.columns.resize(candidates_.size());
  cover_rows(first, 0);
}

std::vector<std::size_t> CoverProblem::keep_only(const std::vector<char>& kept) {
  std::vector<std::size_t> number(candidates_.size());
  std::size_t count = 0;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (kept[c] == 0) continue;
    number[c] = count;
    candidates_[count] = candidates_[c];
    if (count != c) instance_.columns[count] = std::move(instance_.columns[c]);
    ++count;
  }
  candidates_.resize(count);
  instance_.columns.resize(count);
  entries_ = 0;
  for (std::vector<std::uint32_t>& columns : columns_of_) columns.clear();
  for (std::size_t c = 0; c < count; ++c) enter(c, 0);
  return number;
}

// Notes which rows from `first_row` on the columns from `first_column` on cover.
void CoverProblem::cover_rows(std::size_t first_column, std::size_t first_row) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(rows_.size() - first_row);
  for (std::size_t r = first_row; r < rows_.size(); ++r) points.push_back(rows_[r].point);
  const PointGrid grid(points, kCube * max_error_);
  std::vector<std::size_t> known(candidates_.size());
  for (std::size_t c = first_column; c < known.size(); ++c) known[c] = instance_.columns[c].size();
  parallel_for(first_column, candidates_.size(), [&](std::size_t c) {
    const Candidate& candidate = candidates_[c];
    std::vector<std::uint32_t> near;
    const double reach = radius(candidate);
    grid.find(candidate.center, reach, near);
    for (const std::uint32_t i : near) {
      const std::size_t row = first_row + i;
      if (margin(candidate, reach, rows_[row]) >= 0.0) {
        instance_.columns[c].push_back(static_cast<std::uint32_t>(row));
      }
    }
  });
  columns_of_.resize(rows_.size());
  for (std::size_t c = first_column; c < candidates_.size(); ++c) enter(c, known[c]);
}

void CoverProblem::enter(std::size_t column, std::size_t first) {
  const std::vector<std::uint32_t>& covered = instance_.columns[column];
  entries_ += covered.size() - first;
  for (std::size_t i = first; i < covered.size(); ++i) {
    columns_of_[covered[i]].push_back(static_cast<std::uint32_t>(column));
  }
}

}  // namespace spherule::internal
