// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "geometry/pose.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// More and smaller spheres over the same mesh: `count` of them (fewer if the mesh runs out of
// pieces, never less than the spheres of the cover that have a piece to hold). Every triangle of
// the mesh is cut into pieces, each inside a sphere of the cover; every new sphere encloses some of
// the pieces of one old sphere, and lies within this sphere grown by `slack`. So the new set covers
// the triangles, as the old one does, and is nowhere larger by more than `slack`: the same body
// with the same clearance. The inside of the body, where the old spheres fill it, is not covered.
//
// Both in exact arithmetic for the numbers as stored, but for the corners of the pieces, which are
// rounded, and for which radii are 1e-9 of themselves larger than they need be. Deterministic.
// Throws Error if the cover does not hold a piece of a triangle even after it was halved 40 times.
std::vector<Sphere> refine_cover(const TriangleMesh& mesh, std::span<const Sphere> cover,
                                 std::size_t count, double slack);

// Not more than `count` spheres (one at least) that cover all that the spheres of the tree cover: a
// cut through the tree, where the largest sphere was opened again and again. Every sphere of a
// layered tree holds all below it.
std::vector<Sphere> coarse_cover(const SphereTree& tree, std::size_t count);

// Two bodies as an engine knows them. Poses are handed over beforehand, so that changing them into
// the engine's own kind is not timed.
class PairEngine {
 public:
  virtual ~PairEngine() = default;
  // b stands still at the origin.
  virtual void set_poses(std::span<const Pose> world_from_a) = 0;
  virtual bool collides(std::size_t pose) = 0;
  // Of surfaces, or of sphere sets.
  virtual double distance(std::size_t pose) = 0;
};

struct NamedPairEngine {
  std::string name;
  std::unique_ptr<PairEngine> engine;
};

// FCL on two meshes in every setting that is not far slower than another: oriented boxes, or these
// with rectangle-swept spheres, or the latter alone for distances; in double from the packaged
// library and in float.
std::vector<NamedPairEngine> fcl_collide_engines(const TriangleMesh& a, const TriangleMesh& b);
// The same behind a test of the exact boxes along the world's axes.
std::vector<NamedPairEngine> fcl_boxed_collide_engines(const TriangleMesh& a,
                                                       const TriangleMesh& b);
std::vector<NamedPairEngine> fcl_distance_engines(const TriangleMesh& a, const TriangleMesh& b);

// Nanoseconds a configuration of each checker. They take turns at short runs of the configurations,
// in several rounds; of each run the least time counts, since what else the machine does can only
// add. One more round goes first, untimed.
std::vector<double> time_in_turns(std::span<const std::unique_ptr<Checker>> checkers,
                                  std::span<const ArmPositions> configurations, int rounds);

// What a checker says of all of them.
std::vector<std::uint8_t> verdicts_of(Checker& checker,
                                      std::span<const ArmPositions> configurations);

// Seeded; the same on every library, since they are made of the generator's bits.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : bits_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }

  // Uniform in directions and rotations, by rejection from the cube.
  Eigen::Vector3d direction() { return in_sphere<Eigen::Vector3d>().normalized(); }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond(in_sphere<Eigen::Vector4d>().normalized().eval());
  }

 private:
  template <class Vector>
  Vector in_sphere() {
    for (;;) {
      Vector v;
      for (double& x : v) x = between(-1.0, 1.0);
      const double norm = v.norm();
      if (norm <= 1.0 && norm > 0.01) return v;
    }
  }

  std::mt19937_64 bits_;
};

}  // namespace spherule
