// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/local_error.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

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

}  // namespace spherule::internal
