// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/closing/protrusion_judge.h"

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

// Of a node that does not count.
inline constexpr float kFar = 1e30F;

// Replaces the heights by, at every node z, the least of |z - x|^2 + height(x) over all nodes x, in
// steps: squared distances where the heights are 0 or kFar, powers where they are -radius^2. Exact
// but for rounding (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions").
void transform_distances(const Grid& grid, std::vector<float>& heights);

// The solid C closed at a diameter d: what no open sphere of radius rho = d / 2 intersects that
// gets from far away to where it is without meeting the mesh in its inside. Known from both sides
// on the nodes of a grid of step h, from the distance of the mesh at nodes alone. With e half the
// diagonal of a node's cube:
//  - nodes are *free* that a sphere of radius rho provably reaches: from node to node where the
//    distances are at least rho on the straight way. It gets to all of the sphere that touches the
//    mesh, too;
//  - cubes are *possible* if the distance at the node is at least rho - e, and are connected with
//    the outside through faces of such. Every centre that is reached lies in one of them.
class ClosedSolid {
 public:
  // Over a box that holds the mesh: the grid leaves the sphere room on every side of it.
  ClosedSolid(const TriangleTree& mesh, const Eigen::AlignedBox3d& box, double rho, double step);
  // Finer, in a part of another one's: from that one's node `center`, `half` of its steps to every
  // side, each cut into `pieces`. What was proved there is known here.
  ClosedSolid(const ClosedSolid& coarse, const Index& center, int half, int pieces);

  const Grid& grid() const { return grid_; }
  double rho() const { return rho_; }
  const TriangleTree& mesh() const { return mesh_; }

  // Bounds of the distance from each node to C, in units of length. The upper ones do not regard
  // the mesh itself, which is a part of C. In a part of another one's grid they are worse near its
  // rim: centres within rho, and points of C, are not known beyond it.
  std::vector<float> least_distances() const;
  std::vector<float> greatest_distances() const;

 private:
  // Distances where they are within e below rho to 2 e above; else a bound that is beyond that.
  void measure();
  void measure_cube(const Index& low, int edge, double limit);
  // Whether a cube around a point intersects one that is possible, or is not all in the grid.
  bool touches_possible(const Eigen::Vector3d& p, double edge) const;
  void spread_possible(std::vector<std::size_t>& waiting, const ClosedSolid* coarse);
  void spread_free(std::vector<std::size_t>& waiting);
  bool passes(const Eigen::Vector3d& a, double at_a, const Eigen::Vector3d& b, double at_b,
              int depth) const;

  const TriangleTree& mesh_;
  double rho_;
  Grid grid_;
  bool is_whole_;
  std::vector<float> distance_;
  std::vector<char> free_;
  std::vector<char> possible_;
};

}  // namespace spherule::closing
