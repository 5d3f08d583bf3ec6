// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/sphere_tree.h"

#include "spheretree/check.h"
#include "spheretree/error.h"
#include "spheretree/moved_from.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace spherule {

SphereTree::SphereTree(SphereTreeData data) : data_(std::move(data)) {
  const TreeReport report = check(data_);
  if (!report.valid) throw Error("sphere tree", report.problems.front());
  depth_ = report.depth;
  branching_ = report.branching;
  measure();
}

SphereTree::SphereTree(SphereTree&& other) noexcept
    : data_(std::exchange(other.data_, {})),
      depth_(other.depth_),
      branching_(other.branching_),
      root_(other.root_),
      reach_(std::exchange(other.reach_, std::numeric_limits<double>::infinity())),
      box_(other.box_) {}

SphereTree& SphereTree::operator=(SphereTree&& other) noexcept {
  if (this == &other) return *this;
  data_ = std::exchange(other.data_, {});
  depth_ = other.depth_;
  branching_ = other.branching_;
  root_ = other.root_;
  reach_ = std::exchange(other.reach_, std::numeric_limits<double>::infinity());
  box_ = other.box_;
  return *this;
}

void SphereTree::measure() {
  root_ = sphere(0);
  reach_ = 0.0;
  // Rounding keeps the order, so the least of the rounded numbers is the least one, rounded.
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (const Sphere& sphere : data_.spheres) {
    reach_ = std::max(reach_, add_up(norm_upper(sphere.center), sphere.radius));
    low = low.min(sphere.center.array() - sphere.radius);
    high = high.max(sphere.center.array() + sphere.radius);
  }
  for (int i = 0; i < 3; ++i) {
    const double least = next_down(low[i]);
    const double most = next_up(high[i]);
    const double center = 0.5 * (least + most);
    box_.center[i] = center;
    box_.half_size[i] = std::max(sub_up(center, least), sub_up(most, center));
  }
}

std::vector<Sphere> SphereTree::level(int level) const {
  assert(level >= 0);
  internal::require_content(node_count() > 0, "SphereTree");
  std::vector<Sphere> spheres;
  // Breadth-first order: the nodes at one distance from the root are consecutive.
  std::size_t begin = 0;
  std::size_t end = 1;
  for (int distance = 0; begin < end; ++distance) {
    std::size_t next_end = end;
    for (std::size_t node = begin; node < end; ++node) {
      if (distance == level || is_leaf(node)) spheres.push_back(sphere(node));
      next_end += static_cast<std::size_t>(child_count(node));
    }
    if (distance == level) break;
    begin = end;
    end = next_end;
  }
  return spheres;
}

}  // namespace spherule
