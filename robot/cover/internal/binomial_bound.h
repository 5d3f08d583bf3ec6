// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace spherule::internal {

// The upper end of the one-sided confidence interval of Clopper and Pearson (1934) for the
// probability of an event that `hits` of `trials` independent trials showed: the largest
// probability under which so few hits have at least the probability 1 - confidence. In at least the
// share `confidence` of all samples it is not below the true probability, whatever that is. Up to
// rounding of about 1e-12; 1 without trials. At most `trials` hits, confidence in (0, 1).
double share_upper_bound(std::size_t hits, std::size_t trials, double confidence);

}  // namespace spherule::internal
