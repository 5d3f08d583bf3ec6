// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <span>

namespace spherule::internal {

// What a subdivision proved about a set of points X and the union of a set of spheres.
struct CoverageProof {
  // Bounds of the uncovered depth of X; upper is 0 exactly if X is proved to be covered.
  double lower = 0.0;
  double upper = 0.0;
  Eigen::Vector3d deepest = Eigen::Vector3d::Zero();  // witness of `lower`, if that is positive
  std::size_t examined = 0;

  // Joins the proofs of two parts of X. The first of equal witnesses is kept.
  void join(const CoverageProof& other) {
    if (other.lower > lower) {
      lower = other.lower;
      deepest = other.deepest;
    }
    upper = std::max(upper, other.upper);
    examined += other.examined;
  }
};

// The spheres with their search structure.
struct SpheresToProve {
  std::span<const Sphere> spheres;
  const SphereHierarchy& hierarchy;
};

// X = the triangles. They are halved at their longest edge until a piece
// lies in a single sphere (a sphere is convex: corners in it, piece in it) or is smaller than
// `finest`, at least 2^-40 of the largest coordinate.
CoverageProof prove_surface(const TriangleMesh& mesh, const SpheresToProve& spheres, double finest);

// A point of X outside of the spheres; none if the depth is 0.
struct KnownLeak {
  double depth = 0.0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

// X = S. Cells of its box are halved until one, as far as it is in S, lies in a single sphere, or
// is smaller than `finest`; where its centre is outside of S, than a share of `finest` that
// solid_query.h states. The part of S in a cell is bounded by the external sphere that is nearest
// to its centre. `is_witness` tells whether a point, of S or of the mesh, may be reported as a
// leak; it is called by several threads. The search starts from the leak that is known.
CoverageProof prove_solid(const Clearance& clearance, const MeshDistance& distance,
                          const SpheresToProve& spheres, double finest,
                          const std::function<bool(const Eigen::Vector3d&)>& is_witness,
                          const KnownLeak& known = {});

}  // namespace spherule::internal
