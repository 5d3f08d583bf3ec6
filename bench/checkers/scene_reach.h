// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

namespace spherule {

// Upper bound, up to rounding, of how far from the world's origin any point of the workload's trees
// can be, in any configuration, in metres: the length along the chain, or the obstacle's reach.
double scene_reach(const Workload& workload);

// What engines in single precision add to each radius. With v = 2^-24 and S the reach: a centre
// that is rounded, and one that is moved by a matrix and a shift that are, err by less than 2 v S
// and 12 v S (in each coordinate 1 v S for each of: centre, matrix, shift, three products and sums;
// times the root of three); a rotation that is the product of two rounded ones by 6 v S more.
// Squares, sums and differences change where a pair counts as touching by less than 6 v S. Twice
// the sum: what the root sphere that a body is tested with in front loses is no more than that.
double single_precision_pad(double reach);

}  // namespace spherule
