// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_tree.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// A box for each node of a mesh's tree, in the axes of the mesh's frame, beside its sphere: the
// long thin triangles of CAD models have spheres that overlap by the hundred where boxes are apart.
class NodeBoxes {
 public:
  explicit NodeBoxes(const MeshTree& mesh);

  // Holds every triangle below the node. In single precision, rounded outward: each coordinate has
  // |center| + half size <= reach (1 + 2^-21) + 2^-125, reach being that of the tree.
  AxisAlignedBox box(std::size_t node) const;

 private:
  struct Stored {
    float center[3];
    float half_size[3];
  };
  std::vector<Stored> boxes_;
};

}  // namespace spherule::internal
