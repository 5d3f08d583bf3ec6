// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace spherule {

// What a query costs in one tree over a set of spheres: collide() up to the first contact, means
// over random poses of a rod near the pipe.
struct TreeCost {
  std::size_t nodes = 0;  // inner ones too
  int depth = 0;
  double node_tests = 0.0;
  double ns = 0.0;
};

// A tree of the literature, and ours over the same leaves. The traversal is the same.
struct TreeRow {
  std::string method;
  std::size_t leaves = 0;
  double collision_percent = 0.0;
  TreeCost own = {};
  TreeCost ours = {};
};

// The paper's pipe by the octree of Liu, Palmer and Grimsdale, by Hubbard's levels and by those of
// the adaptive medial axis, each as its method has it (parents made to enclose their children where
// they do not). Throws Error if a tree and ours answer otherwise.
std::vector<TreeRow> study_trees();

void print_trees(const std::vector<TreeRow>& rows);

}  // namespace spherule
