// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/closing/grid.h"
#include "bench/closing/triangle_tree.h"

#include <cstddef>
#include <vector>

namespace spherule::closing {

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
