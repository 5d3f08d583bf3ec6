// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule::internal {

// The order of a heap for a best-first search: on top is what has the greatest upper bound, ties to
// the oldest.
struct BestFirst {
  template <typename Open>
  bool operator()(const Open& a, const Open& b) const {
    return a.upper < b.upper || (a.upper == b.upper && a.order > b.order);
  }
};

}  // namespace spherule::internal
