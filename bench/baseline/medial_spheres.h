// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/baseline/mesh_probe.h"
#include "geometry/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// A sphere about a Voronoi vertex inside of the solid. It is empty of sites and has at least four
// of them on its boundary, up to rounding.
struct MedialSphere {
  Sphere sphere;
  double clearance = 0.0;  // of the centre: its distance to the surface
  // Upper bound of the largest distance from a point of the sphere to the solid.
  double protrusion() const { return sphere.radius - clearance; }
};

// When an adaptive approximation is good enough: all of it holds, or the limit is reached.
struct MedialGoal {
  double max_protrusion = 0.0;  // of every medial sphere, and gap of every watched point
  std::size_t min_spheres = 0;
  std::size_t max_sites = 0;
};

// The medial axis of a solid as spheres about Voronoi vertices of sites on its surface, refined
// where that pays (Bradshaw and O'Sullivan 2004): a sphere that protrudes has the point of the
// surface that is nearest to its centre inside, and becomes smaller spheres once that is a site.
// Departures: sites are added many at a time, the worst spheres' first and none in a sphere that
// another new site has hit, and the diagram is made anew each time; the protrusion is bounded by
// one distance query; a point of `watched` that all spheres leave open by more than is allowed
// becomes a site, which stands for their rules about parts of the surface that are not covered.
class MedialAxis {
 public:
  // `sites` and `watched` are points of the surface.
  MedialAxis(const SolidProbe& probe, std::vector<Eigen::Vector3d> sites,
             std::span<const Eigen::Vector3d> watched = {});

  void refine(const MedialGoal& goal);

  // From here on these are watched; they begin with those watched so far.
  void watch(std::span<const Eigen::Vector3d> watched);

  const std::vector<MedialSphere>& spheres() const { return spheres_; }
  const std::vector<Eigen::Vector3d>& sites() const { return sites_; }

 private:
  void find_spheres();
  bool add_sites(const MedialGoal& goal);

  const SolidProbe& probe_;
  std::vector<Eigen::Vector3d> sites_;
  std::span<const Eigen::Vector3d> watched_;
  std::vector<bool> is_site_;  // of the watched points: became one
  std::vector<MedialSphere> spheres_;
};

// The least of |p - c| - r over the spheres: not positive where one of them holds p. Infinite
// without spheres.
double gap(const Eigen::Vector3d& point, std::span<const MedialSphere> spheres);

}  // namespace spherule::internal
