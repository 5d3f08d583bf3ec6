// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Solids made of cubic cells: meshes that are not convex, whose inside and whose distance from a
// point are exact by the cells alone. FCL tells how far the surfaces of two are apart.

#include "collide/meshes/mesh_contact.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace spherule::test {

// Cells that share faces in a bent row, which may close.
class VoxelSolid {
 public:
  VoxelSolid(Random& random, int cells, double cell_size);

  const TriangleMesh& mesh() const { return mesh_; }
  // Covered by one sphere for each cell, which protrudes from its faces by 0.37 cell sizes.
  const std::shared_ptr<const CoveredMesh>& covered() const { return covered_; }

  // How far a point of the solid's frame is from the solid; 0 inside.
  double distance_from(const Eigen::Vector3d& p) const;
  // The least height of a point of the placed solid.
  double lowest(const Pose& world_from_solid) const;
  // How far a primitive of this radius about its origin is away, as distance_between() of two.
  double distance_from(const Pose& world_from_solid, const Primitive& other, double radius,
                       const Pose& world_from_other) const;

 private:
  friend double distance_between(const VoxelSolid& a, const Pose& world_from_a, const VoxelSolid& b,
                                 const Pose& world_from_b);
  void make_mesh(const std::vector<Eigen::Vector3i>& cells);

  double half_;         // of a cell's size
  double reach_ = 0.0;  // of the mesh from the origin
  std::vector<Eigen::Vector3d> centers_;
  TriangleMesh mesh_;
  std::shared_ptr<const CoveredMesh> covered_;
  std::shared_ptr<const FclSolid> surface_;
};

// 0 where the two have a point in common. Where it is above kFarApart, a lower bound that is above
// that, too.
inline constexpr double kFarApart = 0.1;
double distance_between(const VoxelSolid& a, const Pose& world_from_a, const VoxelSolid& b,
                        const Pose& world_from_b);

}  // namespace spherule::test
