// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <span>
#include <string>

namespace spherule::test {

// What is wrong with the tree, or an empty text. Judges the five invariants of SphereTree in exact
// arithmetic, by walking from the root; shares no code with check().
std::string fault_of(const SphereTreeData& data);

// Edges on the longest way from the root, by the same walk. The data must have no fault.
int depth_of(const SphereTreeData& data);

// A lower bound on the radius of every sphere that encloses all `spheres`, computed in long double
// from the dual problem about the centre of `candidate`; tight exactly if `candidate` is the
// smallest.
//
// f(c) = max_i |c - c_i| + r_i is convex. With unit vectors u_i from c_i to c and weights l_i >= 0
// of sum 1: f(c') >= sum l_i (|c - c_i| + r_i) - |sum l_i u_i| |c' - c| for every c'. The best c'
// is within f(c) - r_i of every c_i, which bounds |c' - c|. The weights are those of the point of
// least norm in the hull of the u_i of the spheres that touch, found by exchanging points of a
// simplex.
long double smallest_radius_lower_bound(const Sphere& candidate, std::span<const Sphere> spheres);

}  // namespace spherule::test
