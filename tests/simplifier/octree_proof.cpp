// SPDX-License-Identifier: BSD-3-Clause
#include "tests/simplifier/octree_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Real = long double;

// A difference of a corner and a centre, its square, the sum of three of them and the square of a
// radius are off by at most 8 roundings of themselves together: 2^-64 each, or 2^-53 in double.
template <class Number>
constexpr Number kSlack = Number(sizeof(Number) == sizeof(double) ? 0x1p-47L : 0x1p-58L);

struct Cube {
  std::array<Real, 3> low;
  std::array<Real, 3> high;
};

// The part of a cube in the box, which may be flat; none if they are disjoint. Exact.
bool clip(Cube& cube, const Eigen::AlignedBox3d& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    cube.low[k] = std::max<Real>(cube.low[k], box.min()[axis]);
    cube.high[k] = std::min<Real>(cube.high[k], box.max()[axis]);
    if (cube.low[k] > cube.high[k]) return false;
  }
  return true;
}

enum class Relation { kApart, kIntersects, kInside };

// How a cube lies to a sphere: surely apart from the closed one, surely inside of the open one, or
// neither. Its corners are numbers of that kind.
template <class Number>
Relation relation(const Cube& cube, const Sphere& sphere) {
  Number nearest = 0;
  Number furthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Number c = sphere.center[static_cast<Eigen::Index>(k)];
    const Number below = static_cast<Number>(cube.low[k]) - c;
    const Number above = static_cast<Number>(cube.high[k]) - c;
    const Number near = std::max({below, -above, Number(0)});
    const Number far = std::max(std::abs(below), std::abs(above));
    nearest += near * near;
    furthest += far * far;
  }
  const Number radius = sphere.radius;
  if (furthest * (1 + kSlack<Number>) < radius * radius) return Relation::kInside;
  return nearest * (1 - kSlack<Number>) > radius * radius ? Relation::kApart
                                                          : Relation::kIntersects;
}

bool is_in_double(const Cube& cube) {
  const auto is_double = [](Real x) { return static_cast<double>(x) == x; };
  return std::ranges::all_of(cube.low, is_double) && std::ranges::all_of(cube.high, is_double);
}

// The spheres that meet the cube; true if one of them holds it.
bool select(const Cube& cube, std::span<const Sphere> from, std::vector<Sphere>& meeting) {
  const bool in_double = is_in_double(cube);
  for (const Sphere& sphere : from) {
    // Nearly all are told apart, or found to hold it, by fewer digits.
    Relation found = in_double ? relation<double>(cube, sphere) : Relation::kIntersects;
    if (found == Relation::kIntersects) found = relation<Real>(cube, sphere);
    if (found == Relation::kInside) return true;
    if (found == Relation::kIntersects) meeting.push_back(sphere);
  }
  return false;
}

class Prover {
 public:
  Prover(const Eigen::AlignedBox3d& box, int max_depth, std::size_t max_cubes)
      : box_(box), max_depth_(max_depth), max_cubes_(max_cubes) {}

  // False as soon as the verdict is not kCovered.
  bool prove(const Cube& cube, std::span<const Sphere> external, std::span<const Sphere> spheres,
             int depth) {
    Cube part = cube;
    if (!clip(part, box_)) return true;
    ++proof.cubes;
    std::vector<Sphere> outside;
    std::vector<Sphere> holding;
    if (select(part, external, outside) || select(part, spheres, holding)) return true;
    for (unsigned corner = 0; corner < 8; ++corner) {
      std::array<Real, 3> point;
      for (std::size_t k = 0; k < 3; ++k) point[k] = (corner >> k & 1U ? part.high : part.low)[k];
      proof.point = {static_cast<double>(point[0]), static_cast<double>(point[1]),
                     static_cast<double>(point[2])};
      const bool exact =
          proof.point.x() == point[0] && proof.point.y() == point[1] && proof.point.z() == point[2];
      if (exact && is_leak(proof.point, outside, holding)) return stop(OctreeVerdict::kLeak);
    }
    if (depth == max_depth_ || proof.cubes >= max_cubes_) return stop(OctreeVerdict::kUndecided);
    for (unsigned child = 0; child < 8; ++child) {
      Cube eighth = cube;
      for (std::size_t k = 0; k < 3; ++k) {
        const Real half = (cube.low[k] + cube.high[k]) / 2.0L;
        (child >> k & 1U ? eighth.low : eighth.high)[k] = half;
      }
      if (!prove(eighth, outside, holding, depth + 1)) return false;
    }
    return true;
  }

  OctreeProof proof;

 private:
  static bool is_leak(const Vector3d& p, std::span<const Sphere> outside,
                      std::span<const Sphere> holding) {
    const Cube point{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
    const auto is_apart = [&](const Sphere& sphere) {
      return relation<Real>(point, sphere) == Relation::kApart;
    };
    return std::ranges::all_of(outside, is_apart) && std::ranges::all_of(holding, is_apart);
  }

  bool stop(OctreeVerdict verdict) {
    proof.verdict = verdict;
    return false;
  }

  const Eigen::AlignedBox3d& box_;
  int max_depth_;
  std::size_t max_cubes_;
};

}  // namespace

OctreeProof prove_by_octree(const ExternalSpheres& external, std::span<const Sphere> spheres,
                            int max_depth, std::size_t max_cubes) {
  // A cube about the box with an edge 2^k, its corner at multiples of 2^(k - 10): all corners of
  // the octree are multiples of 2^(k - 50) at most, hence exact in 64 bits if the box is not
  // further than 2^13 edges from the origin.
  const double size = std::max(external.box.sizes().maxCoeff(), 1e-300);
  const int k = std::ilogb(size) + 2;
  Cube cube;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = external.box.min()[static_cast<Eigen::Index>(axis)];
    cube.low[axis] = std::ldexp(std::floor(std::ldexp(low, 10 - k)), k - 10);
    cube.high[axis] = cube.low[axis] + std::ldexp(1.0L, k);
  }
  Prover prover(external.box, std::min(max_depth, 40), max_cubes);
  if (external.box.min().cwiseAbs().maxCoeff() > std::ldexp(1.0, k + 12)) {
    return {OctreeVerdict::kUndecided, external.box.min(), 0};
  }
  prover.prove(cube, external.spheres, spheres, 0);
  return prover.proof;
}

}  // namespace spherule::test
