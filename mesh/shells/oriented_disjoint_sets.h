// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace spherule::internal {

// Disjoint sets of which every element is turned like the one that stands for its set (+1) or the
// other way round (-1).
class OrientedDisjointSets {
 public:
  struct Place {
    int root;
    int turn;  // against that of the root
  };

  explicit OrientedDisjointSets(std::size_t count) : up_(count), turn_(count, 1) {
    std::iota(up_.begin(), up_.end(), 0);
  }

  Place find(int v) {
    int turn = 1;
    while (up(v) != v) {
      turn_of(v) *= turn_of(up(v));
      up(v) = up(up(v));
      turn *= turn_of(v);
      v = up(v);
    }
    return {v, turn};
  }
  // Elements of one set already stay turned as they are.
  void join(int a, int b, int turn = 1) {
    const Place of_a = find(a), of_b = find(b);
    if (of_a.root == of_b.root) return;
    up(of_a.root) = of_b.root;
    turn_of(of_a.root) = of_a.turn * turn * of_b.turn;
  }

 private:
  int& up(int v) { return up_[static_cast<std::size_t>(v)]; }
  int& turn_of(int v) { return turn_[static_cast<std::size_t>(v)]; }

  std::vector<int> up_;
  std::vector<int> turn_;  // against that of the element above
};

}  // namespace spherule::internal
