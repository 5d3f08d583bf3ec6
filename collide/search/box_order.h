// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How trees of boxes share out what they are built over.

#include "spheretree/median_split.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <span>
#include <utility>

namespace spherule::internal {

// Around the boxes `box_of(part)` of all parts.
template <class Part, class BoxOf>
Eigen::AlignedBox3d box_around(std::span<Part> parts, const BoxOf& box_of) {
  Eigen::AlignedBox3d box;
  for (const Part& part : parts) box.extend(box_of(part));
  return box;
}

// Sorts the parts along the longest side of that box, by the middles of their boxes; those with
// equal ones by their `number_of(part)`, so that the order depends on nothing else.
template <class Part, class BoxOf, class NumberOf>
void sort_along_longest_side(std::span<Part> parts, const BoxOf& box_of,
                             const NumberOf& number_of) {
  const Eigen::Index axis = longest_axis(box_around(parts, box_of));
  const auto key = [&](const Part& part) {
    const Eigen::AlignedBox3d& box = box_of(part);
    return std::pair(box.min()[axis] + box.max()[axis], number_of(part));
  };
  std::sort(parts.begin(), parts.end(),
            [&](const Part& a, const Part& b) { return key(a) < key(b); });
}

}  // namespace spherule::internal
