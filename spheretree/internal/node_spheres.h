// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What building, refitting and checking a tree share: the spheres of its nodes.

#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <span>

namespace spherule::internal {

// Throws Error if a number in `spheres` is not usable.
void require_usable(std::span<const Sphere> spheres);

// Equality of all bits: unlike ==, it tells -0.0 from 0.0.
bool same_bits(const Sphere& a, const Sphere& b);

Sphere sphere_of(const SphereTreeData& data, std::size_t node);
void set_sphere(SphereTreeData& data, std::size_t node, const Sphere& sphere);

// The smallest sphere around the spheres of the node's children (at least one, at most
// kMaxBranching), rounded up so that it encloses them in exact arithmetic.
Sphere sphere_around_children(const SphereTreeData& data, std::size_t node);

// Throws Error if the sphere of the root is too large to be usable.
void check_root(const SphereTreeData& data);

}  // namespace spherule::internal
