// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// From many medial spheres to few that cover the same points of the surface: the three reductions
// of Bradshaw and O'Sullivan (2004). Each returned sphere holds the points it is given in
// exact arithmetic, so that all points of the task are covered; between the points nothing is
// promised. Deterministic, ties by index.

#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/mesh_probe.h"
#include "geometry/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <vector>

namespace spherule::internal {

struct ReductionTask {
  const SolidProbe& probe;
  std::span<const Eigen::Vector3d> samples;  // of the surface, or of the solid
  std::span<const std::uint32_t> points;     // those of the samples that are to be covered
  std::span<const MedialSphere> spheres;
  // A point for which every medial sphere would have to grow by more becomes a sphere of radius 0
  // of its own. (Expand grows them in its own way.)
  double max_inflation = std::numeric_limits<double>::infinity();
};

// Where a reduction stops. With a count it goes on until there are no more spheres than that;
// without (0) as long as no sphere has to protrude by more than `max_protrusion`.
struct ReductionGoal {
  std::size_t count = 0;
  double max_protrusion = std::numeric_limits<double>::infinity();
};

// A sphere and the points it is responsible for; every point of a task belongs to one sphere.
struct FittedSphere {
  Sphere sphere;
  double clearance = 0.0;             // of the centre
  std::vector<std::uint32_t> points;  // indices into the samples, ascending
  std::int32_t merged_into = -1;      // set by merge_levels only
  double protrusion() const { return sphere.radius - clearance; }
};

// The largest protrusion of the spheres, an upper bound where clearances are of points inside; 0
// for none.
double largest_protrusion(std::span<const FittedSphere> spheres);

// What the reductions start from: each point goes to the medial sphere that holds it deepest, or
// that has to grow least for it, if that is no more than max_inflation. Spheres without points are
// left out.
std::vector<FittedSphere> assign_points(const ReductionTask& task);

// Merge: two neighbouring spheres become the smallest sphere that encloses their points, the pair
// first whose new sphere protrudes least (Hubbard's merging, by error rather than by volume).
// Departures: spheres are neighbours if they are among the three nearest of some point, not if
// their tetrahedra share a face, so that parts which do not hang together merge too; the sphere
// that encloses both spheres is taken where it protrudes less.
std::vector<FittedSphere> merge(const ReductionTask& task, const ReductionGoal& goal);

// Burst: a sphere is taken out and its neighbours grow about their centres, each for the points
// that it has to grow least for, the sphere first whose heirs protrude least. Neighbours as in
// merge.
std::vector<FittedSphere> burst(const ReductionTask& task, const ReductionGoal& goal);

// Expand: every medial sphere grows until it protrudes by one stand-off distance, and few of them
// that hold all points are chosen greedily; the stand-off distance is the least found, by
// bisection, that needs no more than `count`, or is `max_protrusion`. A point that no medial sphere
// holds then is the centre of a sphere of its own with the stand-off distance as its radius.
// Departure: what greedy choice made superfluous is dropped (set_cover.h).
std::vector<FittedSphere> expand(const ReductionTask& task, const ReductionGoal& goal);

// Merges from `fine` on, down to each of the counts in turn (descending); the last are the finest.
// merged_into tells which sphere of the level before each became part of.
std::vector<std::vector<FittedSphere>> merge_levels(const ReductionTask& task,
                                                    std::span<const std::size_t> counts);

// The spheres of a reduction that are still there, and which are neighbours. Merging and bursting
// work on it.
class ReductionGraph {
 public:
  // The spheres of assign_points, neighbours where both are among the three nearest of some point.
  explicit ReductionGraph(const ReductionTask& task);

  std::size_t size() const {
    return nodes_.size();
  }  // of all indices, those of removed spheres too
  std::size_t live_count() const { return live_count_; }
  bool is_live(std::size_t i) const { return live_[i]; }
  const FittedSphere& operator[](std::size_t i) const { return nodes_[i]; }
  FittedSphere& operator[](std::size_t i) { return nodes_[i]; }
  const std::set<std::uint32_t>& neighbours(std::size_t i) const { return links_[i]; }
  std::vector<std::uint32_t> live() const;  // ascending

  std::uint32_t add(FittedSphere sphere);
  // Takes a sphere out; its neighbours become neighbours of `heir`.
  void remove(std::uint32_t i, std::uint32_t heir);
  // Makes every sphere a neighbour of those nearest to it, where nothing else joins what is left.
  void link_nearest();

 private:
  void link(std::uint32_t a, std::uint32_t b);

  std::vector<FittedSphere> nodes_;
  std::vector<std::set<std::uint32_t>> links_;
  std::vector<bool> live_;
  std::size_t live_count_ = 0;
};

}  // namespace spherule::internal
