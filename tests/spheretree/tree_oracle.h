// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <string>

namespace spherule::test {

// What is wrong with the tree, or an empty text. Judges the five invariants of SphereTree in exact
// arithmetic, by walking from the root; shares no code with check().
std::string fault_of(const SphereTreeData& data);

// Edges on the longest way from the root, by the same walk. The data must have no fault.
int depth_of(const SphereTreeData& data);

}  // namespace spherule::test
