// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/cover.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_set.h"
#include "simplifier/stage2/paper/uncovered_search.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

// Spheres inside of S that leave an error, by which they are then inflated so that they cover S.

namespace spherule::internal {

// Shares of E. Spheres that leave no error above kLoopLimit can be inflated within E: the rest is
// kept for the margin, which lets every piece of a subdivision down to that size lie inside a
// single inflated sphere, as a proof needs it.
inline constexpr double kLoopLimit = 0.97;
inline constexpr double kProofMargin = 0.02;
inline constexpr double kErrorTolerance = 0.01;

// The sphere of S that grows from a seed and moves away from what it touches until it touches in
// two or more places that stop it (medial_ascent.h); where it slides so far from a sharp tip that
// the seed stays further than 0.9 E from it, the last position on its way that comes within 0.5 E.
class SphereInflater {
 public:
  // Options: E, and the diameter of the seeds.
  SphereInflater(const Clearance& clearance, const CoverOptions& options);

  // `rejected` counts seeds that collide; they are moved.
  Sphere operator()(const Eigen::Vector3d& seed, std::size_t& rejected) const;

 private:
  Sphere sphere_at(const Eigen::Vector3d& center) const;
  bool is_near(const Sphere& sphere, const Eigen::Vector3d& point, double share) const;

  const Clearance& clearance_;
  double max_error_;
  double seed_radius_;
};

// Told of the furthest point and of the sphere grown there before it is added.
using SphereNote = std::function<void(const UncoveredSearch::Peak&, const Sphere&)>;

// Grows spheres at the point of S that is furthest from the spheres, until none is further than
// kLoopLimit of E, as proved by subdivision. Throws Error if they get too many.
void fill_gaps(const Clearance& clearance, const MeshDistance& distance,
               const CoverOptions& options, SphereSet& spheres, std::size_t& seeds_rejected,
               const SphereNote& note = {});

// Proved bounds of the greatest distance from a point of S to the spheres, to within
// kErrorTolerance of E.
CoverageProof remaining_error(const Clearance& clearance, const MeshDistance& distance,
                              const std::vector<Sphere>& spheres, double max_error);

// The spheres inflated by `error`, which bounds their remaining error, and kProofMargin of E: they
// cover S. None is smaller than the options' least radius.
void inflate(SphereCover& cover, const std::vector<Sphere>& spheres, double error,
             const CoverOptions& options);

}  // namespace spherule::internal
