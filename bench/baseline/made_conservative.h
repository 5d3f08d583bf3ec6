// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which cells of space a method takes.
//
// @code{.cpp}
// #include <spherule/bench/baseline/made_conservative.h>
// #include <spherule/bench/baseline/voxelisation.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto filling = spherule::Filling::kSurface;
// const auto voxels = spherule::voxelise(tetrahedron, {.step = 0.1, .filling = filling});
// assert(voxels.surface > 0 && voxels.inside == 0);
// @endcode

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/solid_cells.h"

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

namespace spherule {

// Which cells of space a method takes.
enum class Filling {
  kSolid,   // those that the surface intersects and those inside
  kSurface  // those that the surface intersects
};

}  // namespace spherule

// Spheres of any method, grown until they cover.
//
// @code{.cpp}
//
// const spherule::TriangleMesh bar{{{0, 0, 0}, {1, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}},
//                                  {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const std::vector<spherule::Sphere> spheres{{{0.25, 0, 0}, 0.2}, {{0.75, 0, 0}, 0.2}};
// const auto grown = spherule::made_conservative(bar, spheres);
// assert(grown.certificate.covered && grown.inflation > 0.05 && grown.inflation < 0.06);
// @endcode

namespace spherule {

// A set of spheres grown until it covers, and what is proved about it.
struct ConservativeSpheres {
  std::vector<Sphere> spheres;  // the same centres in the same order
  double inflation = 0.0;       // of every radius; 0 if the spheres cover as they are
  Certificate certificate;      // of the grown spheres, against |M|
};

// Conservative. Grows every radius by the proved upper bound of the uncovered depth of |M| grown by
// `padding` and the mesh's vertex_error (certify() without external spheres: a hollow whose way in
// is narrower than 1/128 of the box diagonal counts as solid), and by 1/4096 of the diagonal, with
// which the second proof succeeds. Then every point of it is in a sphere: one at distance d from
// the nearest sphere is in that sphere grown by d. The certificate is that of a second search, on
// the spheres returned. Lengths in the unit of the mesh. On at most `threads` threads, 0: all; the
// result is the same. Throws Error if there is no sphere, if one is not usable or cannot grow any
// more, for a mesh that validate() refuses and for a padding out of range.
ConservativeSpheres made_conservative(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                      double padding = 0.0, int threads = 0,
                                      const Progress& progress = {});

}  // namespace spherule

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

// Edge of a cube whose circumscribed sphere, with its margins for rounding, is nowhere further than
// `max_error` from any point of the cube.
inline double edge_for_error(double max_error) {
  return max_error * (0.5773502691896257 * (1.0 - 0x1p-10));
}

inline void check_padding(double padding) {
  if (!(padding >= 0.0 && padding <= kMaxCoordinate)) {
    throw Error("padding", "must be finite and not negative");
  }
}

}  // namespace spherule::internal
