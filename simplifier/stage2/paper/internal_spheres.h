// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/types/simplification.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace spherule::internal {

// Finds the point of S that is furthest from a growing set of spheres, with proved bounds:
// best-first subdivision of the box of S. A cell with centre q and half diagonal g is at most
// min(|q - c| - r) + g from the spheres everywhere; cells that lie outside of S, or within the
// target, are dropped for good, since spheres are only added. Bounds that are out of date are upper
// bounds, so a cell is brought up to date only when it comes to the top.
class UncoveredSearch {
 public:
  // `target`: errors up to this are not of interest. The greatest error is bracketed to within
  // `tolerance`, or a tenth of what it exceeds the target by if that is more.
  UncoveredSearch(const Clearance& clearance, const MeshDistance& distance, double target,
                  double tolerance);

  struct Peak {
    // In S, up to the rounding of points of the mesh; or, where no point of S could be found near a
    // cell that is too small to be halved (solid_query.h), the centre of that.
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    double upper = 0.0;  // no point of S is further from the spheres
    double lower = 0.0;  // some point of S is this far from them
  };

  // The furthest point for the spheres as they are now; `upper` is the target where none exceeds it
  // (then `point` means nothing and `lower` is 0).
  Peak next(const SphereSet& spheres);

 private:
  struct Cell {
    BoxCell box;
    double upper;
    std::uint64_t order;  // ties are broken by age
    bool inside;          // the cell is wholly in S
  };
  // For a cell of S with its centre outside of S, small enough to stand for a peak; none if it has
  // to be halved.
  std::optional<Peak> peak_beside(const Cell& cell, const SphereSet& spheres) const;
  void push(const Cell& cell);
  Cell pop();

  const Clearance& clearance_;
  const MeshDistance& distance_;
  double target_;
  double tolerance_;
  std::vector<Cell> heap_;
  std::uint64_t made_ = 0;
};

// Spheres inside of S that leave an error, by which they are then inflated so that they cover S.

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

// Measures, over fixed samples, how a growing set of spheres fits the original mesh (the paper's
// figures 6 to 8). Estimates, not proofs: the solid is the inside of a closed mesh, and of an open
// one where the winding number rounds to another number than zero.
class CoverHistory {
 public:
  // `box` holds the solid; spheres may protrude from it by `margin`.
  CoverHistory(const TriangleMesh& mesh, const MeshDistance& distance,
               const Eigen::AlignedBox3d& box, double margin, std::uint64_t seed);

  void add(const Sphere& sphere);

  // The state now; inflating every sphere by `inflation` gives the "after" figures.
  CoverHistoryEntry entry(double inflation) const;

 private:
  struct Sample {
    Eigen::Vector3d point;
    double gap;  // least |p - c| - r so far
  };
  static void update(std::vector<Sample>& samples, const Sphere& sphere);

  std::vector<Sample> surface_;
  std::vector<Sample> solid_;
  std::vector<Sample> outside_;
  std::size_t count_ = 0;
};

// Stage 2 as the paper has it (Algorithm 1, second loop): a sphere is seeded at the point of S that
// is furthest from the spheres so far, grown and moved until it touches the outside in two or more
// places that stop it, until no point of S is further from the spheres than allowed; then every
// radius is inflated by the certified error that remains, so that the spheres cover S.
//
// Departures from the listing: the loop runs while the error is *greater* than the limit; the
// furthest point is found by subdivision with proved bounds, not on samples; a seed of
// min_internal_diameter that collides is moved away from the contact instead of being dropped,
// since the next round would try the same one again; and where the grown sphere slides so far from
// a sharp tip that the tip stays further than half the limit, the last position on its way that
// does not is taken.
SphereCover place_internal_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                   const Clearance& clearance, const CoverOptions& options);

}  // namespace spherule::internal
