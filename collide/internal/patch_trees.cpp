// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/patch_trees.h"

#include "collide/internal/triangle_pair.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Box = Eigen::AlignedBox3d;

struct Piece {
  Box box;
  std::int32_t triangle;
};

// Encloses what the triangle and the ball have in common; empty only if that is nothing.
Box box_of(const Triangle& triangle, const Sphere& ball) {
  Box box(triangle[0]);
  box.extend(triangle[1]).extend(triangle[2]);
  for (int k = 0; k < 3; ++k) {
    box.min()[k] = std::max(box.min()[k], sub_down(ball.center[k], ball.radius));
    box.max()[k] = std::min(box.max()[k], add_up(ball.center[k], ball.radius));
  }
  return box;
}

PatchNode node_of(const Box& box) {
  PatchNode node{};
  for (int k = 0; k < 3; ++k) {
    const double low = box.min()[k], high = box.max()[k];
    const double center = low + (high - low) / 2.0;
    node.center[k] = center;
    node.half[k] = std::max(0.0, std::max(sub_up(high, center), sub_up(center, low)));
  }
  return node;
}

// Makes nodes[at] and all below it; those are appended.
void build(std::span<Piece> pieces, std::size_t at, std::vector<PatchNode>& nodes) {
  Box box = pieces[0].box;
  for (const Piece& piece : pieces) box.extend(piece.box);
  nodes[at] = node_of(box);
  if (pieces.size() == 1) {
    nodes[at].child = ~pieces[0].triangle;
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  std::sort(pieces.begin(), pieces.end(), [axis](const Piece& a, const Piece& b) {
    const double of_a = a.box.min()[axis] + a.box.max()[axis];
    const double of_b = b.box.min()[axis] + b.box.max()[axis];
    return std::pair(of_a, a.triangle) < std::pair(of_b, b.triangle);
  });
  if (nodes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) - 2) {
    throw Error("cover", "its spheres meet too many triangles");
  }
  const std::size_t first = nodes.size();
  nodes[at].child = static_cast<std::int32_t>(first);
  nodes.resize(first + 2);
  build(pieces.first(pieces.size() / 2), first, nodes);
  build(pieces.subspan(pieces.size() / 2), first + 1, nodes);
}

}  // namespace

PatchTrees::PatchTrees(const MeshTree& mesh, std::span<const Sphere> balls,
                       const Lists& triangles) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    pieces.clear();
    for (const std::int32_t triangle : triangles.of(i)) {
      const Box box = box_of(mesh.triangle(triangle), balls[i]);
      if (!box.isEmpty()) pieces.push_back({box, triangle});
    }
    roots_.push_back(pieces.empty() ? -1 : static_cast<std::int32_t>(nodes_.size()));
    if (pieces.empty()) continue;
    nodes_.emplace_back();
    build(pieces, nodes_.size() - 1, nodes_);
  }
}

}  // namespace spherule::internal
