// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A judge of the simplifier's promises that shares no code with it: points are sampled and every
// distance is taken to all spheres in turn, in long double (64 bits of precision). It proves
// nothing, but it cannot share a mistake with the proofs.

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "simplifier/types/zones.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <span>
#include <vector>

namespace spherule::test {

using Real = long double;

Real judged_distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The least of |p - c| - r: not positive exactly if a sphere holds p. Infinite without spheres.
Real gap_to_spheres(const Eigen::Vector3d& p, std::span<const Sphere> spheres);

// Distance to the nearest triangle, by brute force.
Real judged_mesh_distance(const Eigen::Vector3d& p, const TriangleMesh& mesh);

// Whether p is in S as its definition has it: in the closed box and in no open external sphere.
bool is_in_solid(const Eigen::Vector3d& p, const ExternalSpheres& external);

// Of the closed shape; 0 within.
Real zone_distance(const ZoneShape& shape, const Eigen::Vector3d& at);

// Corners, points on edges and points inside of every triangle; more on large ones, about `count`.
std::vector<Eigen::Vector3d> points_on_surface(const TriangleMesh& mesh, std::size_t count,
                                               Random& random);

// Points of S: some in its box, and most on its boundary, where a cover is most easily too small:
// on the faces of the box and just off the external spheres. At most `count`; fewer where S is
// thin.
std::vector<Eigen::Vector3d> points_of_solid(const ExternalSpheres& external, std::size_t count,
                                             Random& random);

// What the judge says about the union of some spheres and a set of points.
struct Judgement {
  std::size_t points = 0;
  std::size_t uncovered = 0;
  Real depth = 0.0L;  // greatest distance of a point from the spheres
  Eigen::Vector3d deepest = Eigen::Vector3d::Zero();
};
Judgement judge_cover(std::span<const Eigen::Vector3d> points, std::span<const Sphere> spheres);

// Points of the spheres that are further than `max_error` from every point of S that is tried for
// them: `per_sphere` points on each sphere, moved towards the centre; and the nearest point of M,
// which is in S.
struct ProtrusionJudgement {
  std::size_t points = 0;
  std::size_t beyond = 0;
  Eigen::Vector3d example = Eigen::Vector3d::Zero();
};
ProtrusionJudgement judge_protrusion(std::span<const Sphere> spheres, const TriangleMesh& mesh,
                                     const ExternalSpheres& external, double max_error,
                                     std::size_t per_sphere, Random& random);

}  // namespace spherule::test
