// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How bounding volume hierarchies halve what they are built over.

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <span>

namespace spherule::internal {

// The axis along which the box is longest; of equally long ones the first.
inline Eigen::Index longest_axis(const Eigen::AlignedBox3d& box) {
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  return axis;
}

// Reorders the items so that those of the first half have keys no greater than the others, and
// returns how many those are: half of them, rounded down. Where no two keys are equal, the halves
// are the same sets with every standard library.
template <class Item, class Key>
std::size_t split_at_median(std::span<Item> items, const Key& key) {
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [&](const Item& a, const Item& b) { return key(a) < key(b); });
  return half;
}

}  // namespace spherule::internal
