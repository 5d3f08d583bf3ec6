// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/collada_document.h"
#include "io/placed_part.h"

#include <string>
#include <vector>

namespace spherule::internal {

// A <skin>: which joints move which vertices of the mesh under it.
struct ColladaSkin {
  Affine bind_shape{};
  std::vector<std::string> joints;
  bool are_ids = false;  // the joints are named by id, not by sid
  std::vector<Affine> inverse_bind;
  // Of each joint; the last list is that of the vertices that stay as the mesh was bound.
  std::vector<std::vector<JointWeight>> weights;
};

// Throws Error for lists that do not fit each other or `vertex_count`, and for weights that do not
// add up to 1.
ColladaSkin collada_skin(const ColladaDocument& document, const ColladaDocument::Element& skin,
                         std::size_t vertex_count);

}  // namespace spherule::internal
