// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/node_boxes.h"

#include "spheretree/rounding.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace spherule::internal {
namespace {

// Numbers below the least normal one are not used, so that boxes hold their triangles also where a
// processor takes such numbers for zero.
constexpr float kLeastNormal = std::numeric_limits<float>::min();

float rounded_or_zero(double value) {
  return std::abs(value) < static_cast<double>(kLeastNormal) ? 0.0F : static_cast<float>(value);
}

// The next float above the one to which `value` is rounded, in whatever direction.
float up_to_float(double value) {
  return std::max(std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()),
                  kLeastNormal);
}

}  // namespace

NodeBoxes::NodeBoxes(const MeshTree& mesh) {
  const SphereTree& tree = mesh.tree();
  std::vector<Eigen::AlignedBox3d> boxes(tree.node_count());
  boxes_.resize(boxes.size());
  // Children come after their parents.
  for (std::size_t node = boxes.size(); node-- > 0;) {
    Eigen::AlignedBox3d& box = boxes[node];
    if (tree.is_leaf(node)) {
      for (const Eigen::Vector3d& corner : mesh.triangle(tree.sphere_index(node))) {
        box.extend(corner);
      }
    }
    for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
      box.extend(boxes[static_cast<std::size_t>(tree.first_child(node) + i)]);
    }
    for (int i = 0; i < 3; ++i) {
      const float center = rounded_or_zero(0.5 * box.min()[i] + 0.5 * box.max()[i]);
      boxes_[node].center[i] = center;
      boxes_[node].half_size[i] =
          up_to_float(std::max(sub_up(box.max()[i], center), sub_up(center, box.min()[i])));
    }
  }
}

AxisAlignedBox NodeBoxes::box(std::size_t node) const {
  const Stored& stored = boxes_[node];
  return {{stored.center[0], stored.center[1], stored.center[2]},
          {stored.half_size[0], stored.half_size[1], stored.half_size[2]}};
}

}  // namespace spherule::internal
