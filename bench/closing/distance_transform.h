// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/closing/grid.h"

#include <vector>

namespace spherule::closing {

// Of a node that does not count.
inline constexpr float kFar = 1e30F;

// Replaces the heights by, at every node z, the least of |z - x|^2 + height(x) over all nodes x, in
// steps: squared distances where the heights are 0 or kFar, powers where they are -radius^2. Exact
// but for rounding (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions").
void transform_distances(const Grid& grid, std::vector<float>& heights);

}  // namespace spherule::closing
