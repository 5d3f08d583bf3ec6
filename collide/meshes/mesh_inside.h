// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_tree.h"
#include "geometry/shells.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Of the rays that are tried in turn: directions in which no drawing has edges, of lengths in (0,
// 1].
inline const std::array<Eigen::Vector3d, 8> kRayDirections = {
    {{0.2876543, 0.5310987, 0.7912345},
     {-0.6123457, 0.3987654, 0.6789012},
     {0.8345679, -0.4210987, 0.3487651},
     {0.1234567, 0.9387654, -0.3012345},
     {-0.4567891, -0.7654321, 0.4456789},
     {0.5678913, -0.2345671, -0.7823456},
     {-0.9012347, 0.1765432, -0.3876543},
     {-0.2109876, -0.6543213, -0.7198765}}};

// One vertex of every connected component, as MeshTree::component_points() says. Triangles are
// connected where they share a vertex position.
std::vector<Eigen::Vector3d> component_points(const TriangleMesh& mesh);

// The inside of a mesh, which is where the winding number of any closed surface
// (shells.h) is not zero, whatever others count there: so where closed parts overlap that are
// turned differently, and in a sealed hollow.
class MeshInside {
 public:
  explicit MeshInside(const TriangleMesh& mesh);

  // Whether any triangle is of a closed surface, and whether all are.
  bool has_inside() const { return has_inside_; }
  bool is_closed() const { return is_closed_; }
  // Around the closed surfaces, and so around the inside; empty where there are none.
  const Eigen::AlignedBox3d& box() const { return box_; }

  // Whether a point is inside; `tree` is of the same mesh. The point may be off by `error`: never
  // false if the exact one is inside; true also if it cannot be told apart from a point of the
  // surface.
  //
  // A winding number is the sum of the signed crossings of a ray with the triangles of a surface.
  // Each crossing is decided with the error of the point counted, so that the sum is that of the
  // ray from the exact point; a ray that passes an edge too near is given up for another one. One
  // ray serves all surfaces, unless it intersects more than 64. Does not allocate.
  bool contains(const MeshTree& tree, const Eigen::Vector3d& point, double error) const {
    return find(tree, point, error).value_or(true);
  }
  // The same, and nothing where it cannot be told.
  std::optional<bool> find(const MeshTree& tree, const Eigen::Vector3d& point, double error) const;

 private:
  std::vector<TriangleRole> roles_;  // of each triangle
  Eigen::AlignedBox3d box_;          // of those that count
  bool has_inside_ = false;
  bool is_closed_ = true;
};

// A box for each node of a mesh's tree, in the axes of the mesh's frame, beside its sphere: the
// long thin triangles of CAD models have spheres that overlap by the hundred where boxes are apart.
class NodeBoxes {
 public:
  explicit NodeBoxes(const MeshTree& mesh);

  // Holds every triangle below the node. In single precision, rounded outward: each coordinate has
  // |center| + half size <= reach (1 + 2^-21) + 2^-125, reach being that of the tree.
  AxisAlignedBox box(std::size_t node) const;

 private:
  struct Stored {
    float center[3];
    float half_size[3];
  };
  std::vector<Stored> boxes_;
};

}  // namespace spherule::internal
