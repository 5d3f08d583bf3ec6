// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <limits>
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

}  // namespace spherule::closing
