// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"

#include <cstdint>
#include <span>
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

}  // namespace spherule::internal
