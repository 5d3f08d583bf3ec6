// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"

#include <cstdint>
#include <span>

namespace spherule::internal {

// Moves a candidate so that the least margin over the given rows of the problem grows
// (docs/covering.md): uphill along the sum of the direction to the worst row and the direction away
// from the contact, in steps that are halved when they do not help, down to a small share of E. The
// clearance returned is a lower bound, as a candidate's is.
Candidate shift(const Clearance& clearance, const CoverProblem& problem, const Candidate& start,
                std::span<const std::uint32_t> rows);

}  // namespace spherule::internal
