// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace spherule::closing {

// Distance of points to a triangle mesh, by a tree of boxes of its own.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  // The least of the distance and `limit`, rounded to double.
  double distance(const Eigen::Vector3d& p,
                  double limit = std::numeric_limits<double>::infinity()) const;
  const Eigen::AlignedBox3d& box() const { return nodes_.front().box; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::size_t begin = 0;  // of its triangles
    std::size_t end = 0;
    std::size_t children = 0;  // the first of two; 0: a leaf
  };
  using Triangle = std::array<Eigen::Vector3d, 3>;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

// How closely the judge examines.
struct JudgeOptions {
  double step = 0.0;  // of the grid; 0: a 32nd of the diameter
  // The step becomes larger, so that the grid has no more nodes.
  std::size_t most_nodes = 20'000'000;
  // Places at which spheres may protrude most, examined again with steps down to an eighth, and
  // the nodes of each of these grids.
  int rounds = 24;
  std::size_t most_nodes_examined = 3'000'000;
  // No further round is spent on what is known this closely.
  double tolerance = 0.0;
};

// The greatest distance of a point of the spheres from the solid closed at the diameter is between
// the two.
struct JudgedProtrusion {
  double lower = 0.0;
  double upper = 0.0;
  Eigen::Vector3d lower_at = Eigen::Vector3d::Zero();  // a point that is so far from it
  Eigen::Vector3d upper_at = Eigen::Vector3d::Zero();  // the middle of the cube that may be
  double step = 0.0;                                   // of the grid, as it was
};

// Judges spheres by the mesh and the diameter alone, and shares no code with stage 1 or what is
// proved of spheres: its own distances of the mesh, its own flood on a regular grid, and distance
// transforms in the place of trees of spheres (closed_solid.h). The steps of the grid are its only
// error, and counted outwards. There must be triangles and spheres.
JudgedProtrusion judge_protrusion_from_closing(const TriangleMesh& mesh,
                                               std::span<const Sphere> spheres, double diameter,
                                               const JudgeOptions& options = {});

}  // namespace spherule::closing
