// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "geometry/sphere.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/zone_index.h"
#include "simplifier/stage2/search/cover_search.h"
#include "simplifier/types/zones.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

namespace spherule::internal {

// E as a function of place. A sphere keeps the promise of all zones if, for each zone Z of its own
// error e, it protrudes by at most e or does not reach into Z:
//   r <= D(c) + e  or  r < dist(c, Z).
// With E elsewhere the largest such radius is D(c) + allowance(c, D(c)), where
//   allowance(c, d) = min(E, min over Z of max(e, dist(c, Z) - d)).
// It is continuous, so that the tolerances of the search can follow it.
class LocalError {
 public:
  LocalError(double max_error, std::span<const Zone> zones) : max_error_(max_error) {
    std::vector<Zone> with_error;
    std::copy_if(zones.begin(), zones.end(), std::back_inserter(with_error),
                 [](const Zone& zone) { return zone.max_error.has_value(); });
    zones_ = ZoneIndex(with_error);
  }

  // How far a sphere about `center` may protrude from S, of which the sphere of radius `clearance`
  // about it is a subset. Rounded down: a radius of at most clearance + allowance, the sum in exact
  // arithmetic, keeps the promise if it is less than the sum.
  double allowance(const Eigen::Vector3d& center, double clearance) const {
    double allowed = max_error_;
    zones_.near(center, clearance + allowed, [&](std::size_t i) {
      const double gap = sub_down(distance_lower(zones_[i].shape, center), clearance);
      allowed = std::min(allowed, std::max(*zones_[i].max_error, gap));
      return clearance + allowed;
    });
    return allowed;
  }

  // By how much lengths of a search that are shares of E shrink within `reach` of a point; 1
  // exactly where no zone is near.
  double scale(const Eigen::Vector3d& point, double reach = 0.0) const {
    return allowance(point, reach) / max_error_;
  }

 private:
  double max_error_;
  ZoneIndex zones_;
};

// A place for a sphere of the cover: radius `clearance` lies in S, `clearance` + E protrudes by E
// (near zones of a smaller error it has to be smaller: LocalError).
struct Candidate {
  Eigen::Vector3d center;
  double clearance;  // lower bound, within a few hundredths of E; kPinched: no point of S is known
};

inline constexpr double kPinched = -1.0;

// Candidates for covering the given points of S: each point is moved inwards by a seeded random
// depth of 0.2 to 1.5 E and from there away from its contacts (medial_ascent.h). Every position on
// the way counts, since the best sphere at an edge sits at depth E and not on the medial axis
// (docs/covering.md). So do those where zones of a smaller error begin to hold the radius back:
// there a sphere that moves on grows too little to contain the one before. Lengths follow the error
// of the place. Of candidates that are nearly at one place the one with most clearance is kept.
std::vector<Candidate> candidates_from(const Clearance& clearance,
                                       std::span<const Eigen::Vector3d> points, double max_error,
                                       std::uint64_t seed, const LocalError& error);

// How far spheres of the cover reach along the boundary of S, by which a search may be coarser
// where they are large. Plain double: this serves searches, never a proof.

// Half the width of what a sphere of radius `inside` + E covers of a plane that cuts off its last
// E: a sphere of S of radius `inside` that touches the plane, grown by E. At a convex edge, which
// such a sphere can only touch with radius 0, it covers about E.
inline double cap_width(double inside, double max_error) {
  return std::sqrt(max_error * (max_error + 2.0 * inside));
}

// Wider caps, as multiples of E, are not told apart: rows as far from each other as this allows are
// few enough.
inline constexpr double kWidestCap = 30.0;

// The inverse of cap_width, for a width of at least E.
inline double inside_radius(double width, double max_error) {
  return (width * width / max_error - max_error) / 2.0;
}

// Whether a sphere of S of radius `inside` touches the boundary of S, up to a share of E, where the
// clearance at `point` is measured to, given as `at`.
bool touched_by(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                double inside, double max_error);

// The greatest cap_width of the spheres that touch there, to a factor of 1.4; no more than
// kWidestCap times E.
double cap_width_at(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                    double max_error);

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

// How many spheres to search for: fewer by a step than are proved. The step is halved where the
// search fails and doubled where it succeeds.
class CoverGoal {
 public:
  std::size_t target() const { return target_; }
  // Half the way to what is proved, below it.
  std::size_t easier() const { return std::min(proved_ - 1, (target_ + proved_) / 2); }

  void failed() {
    target_ = easier();
    step_ = std::max<std::size_t>(1, step_ / 2);
  }
  void reached(std::size_t count) {
    const std::size_t largest = largest_step(count);
    step_ = proved_ == 0 ? largest : std::min(largest, count <= target_ ? 2 * step_ : step_);
    proved_ = count;
    aim();
  }
  // By how many spheres fewer than `count` are searched for at most.
  static std::size_t largest_step(std::size_t count) {
    constexpr std::size_t kPart = 8;
    return std::max<std::size_t>(1, count / kPart);
  }
  // From here on in steps of a small part of the count.
  void restart() {
    constexpr std::size_t kShare = 32;
    step_ = std::max<std::size_t>(1, proved_ / kShare);
    aim();
  }

 private:
  void aim() { target_ = proved_ - std::min(step_, std::max<std::size_t>(1, proved_) - 1); }

  std::size_t target_ = 0;
  std::size_t proved_ = 0;
  std::size_t step_ = 1;
};

}  // namespace spherule::internal
