// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/solid_cells.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace spherule::internal {

// The simplified solid S as stage 2 methods from this library see it.
struct SimplifiedSolid {
  // Throws Error for a mesh, options and an E that cover() would refuse, and for zones of an E of
  // their own in the name of the method.
  SimplifiedSolid(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options, const std::string& method);
  SimplifiedSolid(const SimplifiedSolid&) = delete;
  SimplifiedSolid& operator=(const SimplifiedSolid&) = delete;

  // Points of S, up to rounding, that a cover is made for: one on the boundary in every cell that
  // this crosses, one in the middle of every other, and, since they stick out first, corners and
  // points of the edges of the mesh where they lie on the boundary. (Ridges where external spheres
  // meet elsewhere are left to the proof: what leaks there becomes a sample, too.) At least one.
  std::vector<Eigen::Vector3d> samples(const TriangleMesh& mesh) const;

  double max_error;  // E
  MeshDistance distance;
  Clearance clearance;
  LocalError everywhere;  // E
  SolidCells cells;
};

}  // namespace spherule::internal
