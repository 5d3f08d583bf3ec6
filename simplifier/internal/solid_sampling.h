// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/clearance.h"
#include "simplifier/internal/proof.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spherule::internal {

// Points that stand for S in a set cover: the centres of the cells of a subdivision whose half
// diagonal is at most `spacing`, or half the clearance where that is more (a ball that covers part
// of the deep inside covers much of it). The centre of a cell near the boundary is moved onto it.
std::vector<Eigen::Vector3d> sample_solid(const Clearance& clearance, double spacing);

// Points where the balls do not cover S, at most one per cube of edge `spacing`. Empty only if S is
// proved to be covered: cells are halved until one lies in a single ball or outside of S. A cell is
// given up as a leak where its centre is an uncovered point of S or it is smaller than `finest`.
std::vector<Eigen::Vector3d> find_leaks(const Clearance& clearance, const BallsToProve& balls,
                                        double finest, double spacing);

}  // namespace spherule::internal
