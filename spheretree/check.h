// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Checks the invariants of a sphere tree, of any origin.
//
// @code{.cpp}
// #include <spherule/spheretree/build.h>
// #include <spherule/spheretree/check.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
// spherule::SphereTreeData data = spherule::build_tree(spheres).data();
// assert(spherule::check(data).valid);
// data.radius[0] = 1.5;  // no longer encloses the two
// assert(!spherule::check(data).valid && !spherule::check(data).problems.empty());
// @endcode

#include "spheretree/sphere_tree.h"

#include <string>
#include <vector>

namespace spherule {

// What check() found. `problems` names the invariant and the node, at most kMaxProblems of them.
struct TreeReport {
  static constexpr std::size_t kMaxProblems = 20;

  bool valid = false;
  std::vector<std::string> problems;
  std::size_t sphere_count = 0;
  std::size_t node_count = 0;
  std::size_t leaf_count = 0;
  int depth = 0;      // edges on the longest way from the root to a leaf
  int branching = 0;  // largest number of children
  double root_radius = 0.0;
  // Mean over inner nodes of radius / largest child radius: how much a level loses.
  double mean_inflation = 0.0;
};

// Checks all five invariants of SphereTree with outward rounding: `valid` is true only if they hold
// in exact arithmetic. A sphere that encloses another by less than a few units in the last place
// may be refused; build_tree never makes one. Throws Error only in a thread that does not round to
// nearest (rounding_mode.h).
TreeReport check(const SphereTreeData& data);
TreeReport check(const SphereTree& tree);

}  // namespace spherule
