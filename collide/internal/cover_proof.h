// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_tree.h"
#include "spheretree/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Lists of whole numbers, one after the other.
struct Lists {
  std::vector<std::int32_t> first;  // list i is values[first[i]] .. values[first[i + 1] - 1]
  std::vector<std::int32_t> values;

  std::span<const std::int32_t> of(std::size_t i) const {
    return std::span(values).subspan(static_cast<std::size_t>(first[i]),
                                     static_cast<std::size_t>(first[i + 1] - first[i]));
  }
};

// For every ball the triangles that meet it, sorted. Some may be listed that miss it by rounding.
// Throws Error if there are more than 2^31 - 1 in all.
Lists triangles_meeting(const MeshTree& mesh, std::span<const Sphere> balls);

// Throws Error unless the balls are proved to cover every triangle of the mesh; `triangles` is what
// triangles_meeting() returns for them. Triangles are halved until each piece lies in one ball,
// with outward rounding; the proof is given up, and the triangle named, after so many pieces that
// only a gap, or balls that meet in a point without any overlap, can be the cause.
void prove_cover(const MeshTree& mesh, std::span<const Sphere> balls, const Lists& triangles);

}  // namespace spherule::internal
