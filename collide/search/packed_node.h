// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace spherule::internal {

// The children of an inner node, as one wide test reads them.
struct alignas(64) PackedNode {
  static constexpr int kWidth = 8;

  float x[kWidth];
  float y[kWidth];
  float z[kWidth];
  float radius[kWidth];
  // Of the child: a node, or ~i for the leaf of sphere i. Lanes without a child are spheres of
  // radius zero so far away that nothing reaches them.
  std::int32_t child[kWidth];
};

// A leaf, as the nodes hold it.
struct PackedSphere {
  float center[3];
  float radius;
};

}  // namespace spherule::internal
