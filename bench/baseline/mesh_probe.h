// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/solid/clearance.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

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

}  // namespace spherule::internal
