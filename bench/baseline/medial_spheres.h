// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/mesh_distance.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/solid/clearance.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

// What the methods that work with medial spheres are made of: probes of a solid, samples, medial
// spheres inside of it, and reductions of these to few.

namespace spherule::internal {

// What the methods that work with medial spheres query about a solid, in plain double: it serves
// searches, never a proof. Safe to share between threads.
class SolidProbe {
 public:
  virtual ~SolidProbe() = default;

  // Distance to the boundary, negative outside of the solid. A sphere of radius r about the point
  // protrudes from the solid by at most r minus this.
  virtual double clearance(const Eigen::Vector3d& point) const = 0;

  // The point of the boundary that is nearest to one inside.
  virtual Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const = 0;
};

// The solid inside of a mesh.
class MeshProbe final : public SolidProbe {
 public:
  // The mesh must have passed validate().
  explicit MeshProbe(const TriangleMesh& mesh);

  double clearance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const override {
    return distance_(point).closest;
  }

  // Whether the winding number is closer to another whole number than to zero: right for closed
  // meshes, inverted ones too, and a sensible guess for open ones. The number is that of
  // MeshDistance, with groups of triangles that are far away taken as one (Barill and others, "Fast
  // winding numbers for soups and clouds", 2018, its first-order term).
  bool is_inside(const Eigen::Vector3d& point) const;

 private:
  // The triangles [begin, end) in depth-first order; an inner node's left child is the next node.
  struct Node {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d area = Eigen::Vector3d::Zero();  // sum of the area vectors
    double reach = 0.0;                              // of the triangles from the centre
    std::int32_t right = -1;                         // negative for a leaf
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Corners {
    Eigen::Vector3d a, b, c;
  };

  void build(std::int32_t begin, std::int32_t end);
  double solid_angle_of(std::int32_t node, const Eigen::Vector3d& point) const;

  MeshDistance distance_;
  std::vector<Corners> corners_;
  std::vector<Node> nodes_;
};

// The simplified solid S: its boundary is made of external spheres and faces of the box. Clearances
// inside are lower bounds; outside, the distance to a point of S found beyond the contact, or else
// to the mesh.
class SimplifiedProbe final : public SolidProbe {
 public:
  // Both must stay while this lives.
  SimplifiedProbe(const Clearance& clearance, const MeshDistance& distance)
      : clearance_(clearance), distance_(distance) {}

  double clearance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const override;

 private:
  const Clearance& clearance_;
  const MeshDistance& distance_;
};

inline void check_threads(int threads) {
  if (threads < 0) throw Error("threads", "must not be negative");
}

// How many points are sampled of what `subject` names.
inline void check_samples(const char* subject, std::size_t count, std::size_t least = 1) {
  if (count < least || count > 10'000'000) {
    throw Error(subject, "must be " + std::to_string(least) + " to 10000000");
  }
}

// About `count` points spread evenly over the triangles, each of which gets its share by area, at
// random within it; at least `per_triangle` on each that has an area. Same points for equal input.
std::vector<Eigen::Vector3d> even_samples(const TriangleMesh& mesh, std::size_t count,
                                          std::size_t per_triangle, std::uint64_t seed);

// Of the mesh; 0 if all triangles are degenerate.
double total_area(const TriangleMesh& mesh);

// The corners of the triangles, once each, and points about as far apart as `count` even samples
// are on edges that are sharp (more than some 18 degrees), open, or shared by more than two. What
// only even samples cover sticks out there first.
std::vector<Eigen::Vector3d> edge_samples(const TriangleMesh& mesh, std::size_t count);

// Both: what a cover of the surface is made for. Throws Error for a mesh without area.
std::vector<Eigen::Vector3d> cover_samples(const TriangleMesh& mesh, std::size_t count,
                                           std::size_t per_triangle, std::uint64_t seed);

// A vertex of the Voronoi diagram of some sites: the centre of a sphere that has four of them (or
// more) on its boundary and none inside.
struct VoronoiVertex {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double radius = 0.0;
  std::array<std::uint32_t, 4> sites{};  // ascending
};

// The vertices within the box of the sites, from the Delaunay tetrahedra (qhull, as the lower hull
// of the sites lifted to a paraboloid). Left out are those of tetrahedra so flat that their centre
// has few digits: its distances to the four sites agree to kVoronoiTolerance times the radius plus
// the rounding of the coordinates, or it is dropped. More than four sites on one sphere give
// several vertices in the same place, up to rounding. Empty for fewer than five sites and for sites
// in one plane. Sites that occur twice are one. Deterministic; sorted by `sites`.
std::vector<VoronoiVertex> voronoi_vertices(std::span<const Eigen::Vector3d> sites);

inline constexpr double kVoronoiTolerance = 1e-9;

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

// From many medial spheres to few that cover the same points of the surface: the three reductions
// of Bradshaw and O'Sullivan (2004). Each returned sphere holds the points it is given in
// exact arithmetic, so that all points of the task are covered; between the points nothing is
// promised. Deterministic, ties by index.

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
// Departure: what greedy choice made superfluous is dropped (greedy_set_cover()).
std::vector<FittedSphere> expand(const ReductionTask& task, const ReductionGoal& goal);

// Merges from `fine` on, down to each of the counts in turn (descending); the last are the finest.
// merged_into tells which sphere of the level before each became part of.
std::vector<std::vector<FittedSphere>> merge_levels(const ReductionTask& task,
                                                    std::span<const std::size_t> counts);

// Whether `a` fulfils the goal better: with a wanted count, by protruding less; else by keeping to
// the protrusion, and then by fewer spheres.
bool is_better(const std::vector<FittedSphere>& a, const std::vector<FittedSphere>& b,
               const ReductionGoal& goal);

struct Reduced {
  SphereReduction reduction;  // that made them
  std::vector<FittedSphere> spheres;
};

// What the reduction makes of the task; for kBest, what the best of the three makes.
Reduced reduce(const ReductionTask& task, const ReductionGoal& goal, SphereReduction reduction);

}  // namespace spherule::internal
