// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <vector>

namespace spherule {

// Not more than `count` spheres (one at least) that cover all that the spheres of the tree cover: a
// cut through the tree, where the largest sphere was opened again and again. Every sphere of a
// layered tree holds all below it.
std::vector<Sphere> coarse_cover(const SphereTree& tree, std::size_t count);

}  // namespace spherule
