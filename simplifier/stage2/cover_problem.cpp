// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_problem.h"

#include "mesh/geometry/point_grid.h"
#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <utility>

namespace spherule::internal {
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
