// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Seeded sphere trees and poses that are hard for a collision test. Metres.

#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <vector>

namespace spherule::test {

class SoakRandom : public Random {
 public:
  using Random::Random;

  bool chance(double share) { return unit() < share; }
  // As many of each order of magnitude.
  double magnitude(double low, double high);
  Eigen::Vector3d in_cube(double half_side);
  Eigen::Vector3d direction();
  // Unit or of any length; now and then no turn at all.
  Eigen::Quaterniond rotation();

  // 0, +-1e-12, +-1e-9, +-1e-6, +-1e-4, anything up to 2e-3, or of any order of magnitude.
  double small_gap();
};

// Spheres within about `size` of the origin: scattered, equal, nested, touching, repeated, with
// radii from 0 up to a hundred times the size.
std::vector<Sphere> random_spheres(SoakRandom& random, int count, double size);

// A tree of any branching over them.
SphereTree random_tree(SoakRandom& random, int count, double size);

// One to twelve mostly, sometimes some dozens, and rarely some hundreds.
int random_count(SoakRandom& random);

// Adds the spheres under a pose, rounded.
void add_placed(std::span<const Sphere> spheres, const Pose& world_from_set,
                std::vector<Sphere>& placed);

// How far `movers` have to go along `direction` (unit) until the least gap to `standing` is `gap`,
// coming from where they would be if they had gone far in that direction; nothing if they pass.
std::optional<double> way_to_gap(std::span<const Sphere> standing, std::span<const Sphere> movers,
                                 const Eigen::Vector3d& direction, double gap);

struct PosePair {
  Pose world_from_a;
  Pose world_from_b;
  // Unit; the way that at_gap() took b. Back along it the two come closer first.
  Eigen::Vector3d way = Eigen::Vector3d::UnitX();
};

// Two trees and where to put them.
class ScenePair {
 public:
  explicit ScenePair(SoakRandom& random);

  const SphereTree& a() const { return a_; }
  const SphereTree& b() const { return b_; }
  double size() const { return size_; }

  // Overlapping or not, about as often.
  PosePair anywhere(SoakRandom& random) const;

  // The least gap is `gap`, but for rounding. Nothing if no way to it was found.
  std::optional<PosePair> at_gap(SoakRandom& random, double gap) const;

 private:
  double size_;
  Eigen::Vector3d place_;  // of a in the world
  SphereTree a_, b_;
};

}  // namespace spherule::test
