// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A proof of coverage that shares no code with the simplifier and nothing with its method but the
// definition of S: an octree of cubes with exact corners, every sphere tried on every cube that it
// intersects, in long double with an explicit error. Slow and short.

#include "geometry/sphere.h"
#include "simplifier/simplify.h"

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace spherule::test {

enum class OctreeVerdict {
  kCovered,   // proved: S is a subset of the union of the spheres
  kLeak,      // proved: `point` is in S and in no sphere
  kUndecided  // a cube was to be split too often, or there were too many
};

struct OctreeProof {
  OctreeVerdict verdict = OctreeVerdict::kCovered;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // of the leak, or in the undecided cube
  std::size_t cubes = 0;
};

// Cubes are split `max_depth` times at most, at most 40; no more than `max_cubes` are examined.
OctreeProof prove_by_octree(const ExternalSpheres& external, std::span<const Sphere> spheres,
                            int max_depth = 32, std::size_t max_cubes = 20'000'000);

}  // namespace spherule::test
