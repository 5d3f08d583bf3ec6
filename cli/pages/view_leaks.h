// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/pages/view_page.h"

#include <vector>

namespace spherule {

// The leaks of every item of spheres, searched for on the surfaces of the meshes among the items,
// as items of their own, and hides nothing. Parts are compared with parts of the same link.
std::vector<ViewItem> sampled_leaks(const std::vector<ViewItem>& items);

// Gives the leaks that certificates tell of, in their order, to the sets of spheres among the items
// where there are as many of both, and adds the surfaces of these leaks, of meshes that are there.
void place_leaks(std::vector<ViewItem>& items);

}  // namespace spherule
