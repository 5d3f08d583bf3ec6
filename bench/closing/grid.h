// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <thread>
#include <vector>

namespace spherule::closing {

using Index = std::array<int, 3>;

// Nodes of a regular grid; each stands for the cube of edge `step` around it.
struct Grid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // the first node
  double step = 1.0;
  Index count{};

  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }
  std::size_t at(const Index& i) const {
    return (static_cast<std::size_t>(i[2]) * static_cast<std::size_t>(count[1]) +
            static_cast<std::size_t>(i[1])) *
               static_cast<std::size_t>(count[0]) +
           static_cast<std::size_t>(i[0]);
  }
  Index index(std::size_t node) const {
    const auto nx = static_cast<std::size_t>(count[0]);
    const auto ny = static_cast<std::size_t>(count[1]);
    return {static_cast<int>(node % nx), static_cast<int>(node / nx % ny),
            static_cast<int>(node / nx / ny)};
  }
  Eigen::Vector3d point(const Index& i) const {
    return origin + step * Eigen::Vector3d(i[0], i[1], i[2]);
  }
  Eigen::Vector3d point(std::size_t node) const { return point(index(node)); }
  bool contains(const Index& i) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (i[a] < 0 || i[a] >= count[a]) return false;
    }
    return true;
  }
  // Steps to the nearest face of the grid.
  int depth(const Index& i) const {
    int least = count[0];
    for (std::size_t a = 0; a < 3; ++a) least = std::min({least, i[a], count[a] - 1 - i[a]});
    return least;
  }
  // From a node to a corner of its cube, rounded up; a thousandth of a step pays for the single
  // precision in which distances are kept.
  double half_diagonal() const { return 0.868 * step; }

  template <typename Visit>
  void for_each_face_neighbour(std::size_t node, Visit visit) const {
    const Index here = index(node);
    for (std::size_t a = 0; a < 3; ++a) {
      for (const int by : {-1, 1}) {
        Index other = here;
        other[a] += by;
        if (contains(other)) visit(at(other));
      }
    }
  }
};

// Calls run(i) for i below count on all threads.
template <typename Run>
void in_parallel(std::size_t count, Run run) {
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> threads;
  for (unsigned t = 0; t < std::max(1U, std::thread::hardware_concurrency()); ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) run(i);
    });
  }
}

}  // namespace spherule::closing
