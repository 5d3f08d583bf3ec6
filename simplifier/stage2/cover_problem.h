// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_candidates.h"
#include "simplifier/stage2/local_error.h"
#include "simplifier/stage2/search/set_cover.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The set cover that stands for covering S: rows are points of S, each with its surroundings, a
// small sphere or, along the boundary of S, a disc grown by one, which a single sphere has to
// contain; columns are candidates.
class CoverProblem {
 public:
  using Columns = std::vector<std::size_t>;
  struct Row {
    Eigen::Vector3d point;
    double radius;                                      // of the sphere
    double disc = 0.0;                                  // radius of the disc about the point
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // of the disc
    bool pinched = false;  // no point of S is known there: its own sphere is that of kPinched

    // Of the disc, the point furthest from another.
    Eigen::Vector3d furthest_from(const Eigen::Vector3d& other) const;
  };

  // No sphere has a radius below `min_radius`. Zones may have an error of their own.
  CoverProblem(double max_error, double min_radius, std::span<const Zone> zones = {});

  void add_rows(std::span<const Row> rows);
  void add_candidates(std::span<const Candidate> candidates);

  const SetCoverInstance& instance() const { return instance_; }
  // The columns that cover each row.
  const std::vector<std::vector<std::uint32_t>>& columns_of() const { return columns_of_; }
  const std::vector<Row>& rows() const { return rows_; }
  const Candidate& candidate(std::size_t column) const { return candidates_[column]; }

  const LocalError& error() const { return error_; }

  // Radius of the sphere at a place: E, or the errors of the zones, decide how far it may protrude.
  double radius(const Candidate& candidate) const;
  // The sphere as it is stored: protruding by E at most, by the exact clearance. That of a point of
  // S may be negative as computed; a little less than E can still be proved there.
  Sphere sphere(std::size_t column, const Clearance& clearance) const;
  // How far the row's surroundings lie inside the sphere of the candidate; negative: outside.
  double margin(const Candidate& candidate, const Row& row) const {
    return margin(candidate, radius(candidate), row);
  }
  // The same for the radius of the candidate as computed before.
  static double margin(const Candidate& candidate, double radius, const Row& row) {
    return radius - row.radius - (row.furthest_from(candidate.center) - candidate.center).norm();
  }

  // Forgets all other columns than these; returns the new numbers of the old ones that are kept.
  std::vector<std::size_t> keep_only(const std::vector<char>& kept);

  // How many pairs of a row and a column that covers it there are.
  std::uint64_t entries() const { return entries_; }

 private:
  // Enters the rows of a column, from the `first` in its list on, into columns_of_ and entries_.
  void enter(std::size_t column, std::size_t first);
  void cover_rows(std::size_t first_column, std::size_t first_row);

  double max_error_;
  double min_radius_;
  LocalError error_;
  std::vector<Row> rows_;
  std::vector<Candidate> candidates_;
  SetCoverInstance instance_;  // a column for every candidate
  std::vector<std::vector<std::uint32_t>> columns_of_;
  std::uint64_t entries_ = 0;
};

}  // namespace spherule::internal
