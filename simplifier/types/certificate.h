// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Bounds of a length.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::Bounds depth{.lower = 0.1, .upper = 0.2};
// assert(depth.upper - depth.lower < 0.11);
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "io/sphere_file.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/zones.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace spherule {

// A lower and an upper bound of a length: proved in a Certificate, true up to rounding in a
// MeshDeviation (bench/baseline/mesh_methods.h).
struct Bounds {
  double lower = 0.0;
  double upper = 0.0;
};

}  // namespace spherule

// What is proved about spheres, of any origin, and a mesh.
//
// @code{.cpp}
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const std::vector<spherule::Sphere> large{{{0.25, 0.25, 0.25}, 1}};
// const std::vector<spherule::Sphere> small{{{0.25, 0.25, 0.25}, 0.5}};
// const spherule::CertifyOptions options{.external = &external, .volume = false};
// assert(spherule::certify(tetrahedron, large, options).covered);
// const spherule::Certificate leaky = spherule::certify(tetrahedron, small, options);
// assert(!leaky.covered && leaky.surface_depth.lower > 0.3);  // the corners are out
// @endcode

namespace spherule {

// What spheres are certified against, and how closely.
struct CertifyOptions {
  // The simplified solid to certify against, of this mesh: that it holds M grown by its padding is
  // proved by stage 1, which made it, and not again. Without it |M| itself is certified: what a
  // sphere of 1/128 of the box diagonal cannot reach from outside counts as inside (on a grid: gaps
  // of up to 1/54 may), so that spheres that leave such a gap of M open are not proved to cover.
  const ExternalSpheres* external = nullptr;
  // With `external`: zones in which the protrusion is bounded apart.
  std::span<const Zone> zones = {};
  // Without `external`: padding t, to which the mesh's vertex_error is added. With it, the padding
  // is the one of stage 1.
  double padding = 0.0;
  // Smallest piece of surface and cell of space that is examined, as a share of the box diagonal. A
  // piece of this size that no single sphere contains is reported as a leak with its depth. Never
  // below 2^-40 of the largest coordinate, where halves of a piece are mostly rounding.
  double resolution = 1.0 / 4096.0;
  // Protrusion over |M| is searched to within this share of the box diagonal; 0 leaves it out.
  double protrusion_tolerance = 1.0 / 512.0;
  bool volume = true;  // estimate the volume ratio
  int threads = 0;     // 0: all
  Progress progress = {};
};

// What is proved about a set of spheres, with outward rounding, on the numbers as given.
struct Certificate {
  // G1: M grown by the padding and S (without external spheres: |M|) are subsets of the union of
  // the spheres. True only if proved; false may also mean that the proof did not reach the bottom,
  // then the depth bounds tell how much remains.
  bool covered = false;
  // Uncovered depth, the largest distance from a point of the set to the union of the spheres;
  // lower is witnessed by a point, upper proved. Of the surface M as stored, and of the solid,
  // which holds M grown by the padding.
  Bounds surface_depth;
  Bounds solid_depth;
  // The larger of the two.
  Bounds uncovered_depth;
  // The point that witnesses uncovered_depth.lower, if that is positive.
  Eigen::Vector3d deepest_leak = Eigen::Vector3d::Zero();
  // G2: proved upper bound of the protrusion of the spheres over S; absent without external
  // spheres.
  std::optional<double> protrusion_over_simplified_max;
  // Proved upper bound of the protrusion over S of the points of the spheres that lie in a zone,
  // for every zone requested: the greatest bound of a sphere that may reach into it, 0 if none
  // does.
  std::vector<double> protrusion_in_zones;
  // Proved bounds of the protrusion over |M|; absent if not requested.
  std::optional<Bounds> protrusion_over_mesh;
  // Volume of the union of the spheres over that of the solid mesh, estimated. Absent unless it is
  // requested, the mesh is closed and there are spheres, and where the estimate finds nothing of
  // the one or the other: small things far apart, a mesh without volume.
  std::optional<double> volume_ratio;
  // With external spheres and a closed mesh: volume of what stage 1 fills, S without |M|;
  // estimated, and the standard error of that.
  std::optional<double> filled_volume;
  std::optional<double> filled_volume_error;
  // Of the external spheres, where one is proved.
  std::optional<double> closing_slack;
  std::size_t sphere_count = 0;
  std::size_t pieces = 0;  // surface pieces examined
  std::size_t cells = 0;   // cells of space examined
};

}  // namespace spherule
