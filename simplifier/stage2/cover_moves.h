// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/types/simplification.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace spherule::internal {

// Replaces each sphere of the solution by one shifted to have the most to spare over the rows that
// it alone covers, as long as no row opens. The shifted spheres become candidates of the problem.
void spread(const Clearance& clearance, CoverProblem& problem, CoverProblem::Columns& solution);

// Candidates between the spheres of the solution and rows that they leave open: the few nearest
// spheres are shifted towards each of these rows as far as the rows that they alone cover let them.
std::vector<Candidate> reach_for(const Clearance& clearance, const CoverProblem& problem,
                                 const CoverProblem::Columns& solution,
                                 std::span<const std::uint32_t> open);

// Candidates beside the spheres of these columns: each is moved at random by up to some share of
// how far it reaches along a plane, and from there away from its contact to the medial axis of S
// (which in zones may be too far: unlike those of candidates_from, these stand nowhere on the way).
std::vector<Candidate> perturbed(const Clearance& clearance, const CoverProblem& problem,
                                 const CoverProblem::Columns& columns, std::uint64_t seed);

// Moves a candidate so that the least margin over the given rows of the problem grows
// (docs/covering.md): uphill along the sum of the direction to the worst row and the direction away
// from the contact, in steps that are halved when they do not help, down to a small share of E. The
// clearance returned is a lower bound, as a candidate's is.
Candidate shift(const Clearance& clearance, const CoverProblem& problem, const Candidate& start,
                std::span<const std::uint32_t> rows);

// What every way to cover S refuses, with an Error that names it.

// An E that is not positive and finite.
void check_max_error(double max_error);

// Options out of range.
void check_options(const CoverOptions& options);

// Zones of an error of their own, for a method that knows one max error only.
void refuse_error_zones(const CoverOptions& options, const std::string& method);

// An E of which the searches could not tell such a share.
void check_resolved(const Clearance& clearance, double max_error, double share);

// No part is worth two million spheres: the error is then too small for the model.
void check_count(std::size_t spheres);

// How far some spheres have to grow, each up to a limit of its own, so that given points are
// covered, with a small sum of growths. Plain double: it serves a search, never a proof.
class SphereInflation {
 public:
  // `limits`: the largest radius of every sphere, not below its own.
  SphereInflation(std::span<const Sphere> spheres, std::vector<double> limits);

  // Requires a point to be covered with the sphere of radius `reserve` about it, or as much of
  // that as the spheres allow. False if the radii as they are do so already.
  bool require(const Eigen::Vector3d& point, double reserve);
  // Grows all spheres that could come within `reach` of the point to their limits, for good. False
  // if they are there already.
  bool grow_fully_about(const Eigen::Vector3d& point, double reach);

  // Finds new radii for all that was requested: a point goes to the sphere that has to grow least
  // for it, those first that are hardest to reach; then spheres shrink to what they alone cover,
  // the ones that grew most first.
  void solve();

  // The spheres with the radii found last.
  std::vector<Sphere> spheres() const;

 private:
  struct Offer {
    std::uint32_t sphere;
    double radius;  // that the sphere needs
  };
  using Demand = std::vector<Offer>;  // one of these has to be met

  bool is_met(const Demand& demand) const;
  double inflation(const Offer& offer) const { return offer.radius - least_[offer.sphere]; }
  void shrink();

  std::vector<Sphere> spheres_;
  std::vector<double> least_;
  std::vector<double> limits_;
  std::vector<double> radii_;
  std::vector<Demand> demands_;
};

}  // namespace spherule::internal
