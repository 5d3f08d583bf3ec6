// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/random_scene.h"

#include "spheretree/build.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

double random_size(SoakRandom& random) {
  if (random.chance(0.85)) return random.between(0.05, 2.0);
  return random.magnitude(1e-4, 1e4);
}

double random_radius(SoakRandom& random, double size) {
  switch (random.whole(0, 9)) {
    case 0:
      return 0.0;
    case 1:
      return random.magnitude(1e-15, 1e-3) * size;
    case 2:
      return random.magnitude(1.0, 100.0) * size;
    default:
      return random.between(0.0, 0.4) * size;
  }
}

// With the long double's precision: the gap is to be met within rounding.
std::optional<long double> pair_way(const Sphere& standing, const Sphere& mover,
                                    const Vector3d& direction, double gap) {
  using Wide = Eigen::Matrix<long double, 3, 1>;
  const Wide from = mover.center.cast<long double>() - standing.center.cast<long double>();
  const Wide along = direction.cast<long double>();
  const long double reach = static_cast<long double>(standing.radius) + mover.radius + gap;
  const long double length = along.squaredNorm();
  const long double passed = from.dot(along) / length;
  const long double square = reach * reach - (from - passed * along).squaredNorm();
  if (reach < 0 || square < 0) return std::nullopt;
  return std::sqrt(square / length) - passed;
}

}  // namespace

double SoakRandom::magnitude(double low, double high) {
  return std::exp(between(std::log(low), std::log(high)));
}

Vector3d SoakRandom::in_cube(double half_side) {
  return point(half_side);
}

Vector3d SoakRandom::direction() {
  if (chance(0.1)) return Vector3d::Unit(whole(0, 2)) * (chance(0.5) ? 1.0 : -1.0);
  for (;;) {
    const Vector3d v = in_cube(1.0);
    const double length = v.norm();
    if (length > 0.1 && length < 1.0) return v / length;
  }
}

Eigen::Quaterniond SoakRandom::rotation() {
  if (chance(0.05)) return Eigen::Quaterniond::Identity();
  const Vector3d v = in_cube(1.0);
  Eigen::Quaterniond q(between(0.05, 1.0), v.x(), v.y(), v.z());
  if (chance(0.5)) {
    q.coeffs() *= std::ldexp(1.0, whole(-60, 60));
  } else {
    q.normalize();
  }
  return q;
}

double SoakRandom::small_gap() {
  static constexpr std::array<double, 5> kGaps{0.0, 1e-12, 1e-9, 1e-6, 1e-4};
  const int kind = whole(0, 6);
  const double gap = kind < 5    ? kGaps[static_cast<std::size_t>(kind)]
                     : kind == 5 ? 2e-3 * unit()
                                 : magnitude(1e-17, 1e-3);
  return chance(0.5) ? -gap : gap;
}

std::vector<Sphere> random_spheres(SoakRandom& random, int count, double size) {
  enum Family { kScattered, kEqual, kNested, kTouching, kRepeated, kMixed };
  const auto family = static_cast<Family>(random.whole(kScattered, kMixed));
  // Of the frame's origin; now and then the spheres are far from it.
  const Vector3d place =
      random.chance(0.1) ? random.in_cube(random.magnitude(1.0, 1e4) * size) : Vector3d::Zero();
  const double radius = random.between(0.01, 0.3) * size;
  std::vector<Sphere> spheres{{place + random.in_cube(size), radius}};
  while (spheres.size() < static_cast<std::size_t>(count)) {
    const Sphere last = spheres.back();
    switch (family) {
      case kScattered:
        spheres.push_back({place + random.in_cube(size), random.between(0.0, 0.3) * size});
        break;
      case kEqual:
        spheres.push_back({place + random.in_cube(size), radius});
        break;
      case kNested:
        spheres.push_back({random.chance(0.5)
                               ? last.center
                               : Vector3d(last.center + random.in_cube(0.1 * radius)),
                           last.radius * random.between(0.8, 1.1)});
        break;
      case kTouching: {
        const double next = radius * random.between(0.5, 1.5);
        spheres.push_back({last.center + (last.radius + next) * random.direction(), next});
        break;
      }
      case kRepeated:
        spheres.push_back(random.chance(0.5)
                              ? last
                              : Sphere{place + random.in_cube(size), random_radius(random, size)});
        break;
      case kMixed:
        spheres.push_back({place + random.in_cube(size), random_radius(random, size)});
        break;
    }
  }
  return spheres;
}

SphereTree random_tree(SoakRandom& random, int count, double size) {
  const int branching = random.chance(0.5) ? 8 : random.whole(2, SphereTree::kMaxBranching);
  return build_tree(random_spheres(random, count, size), {.branching = branching});
}

int random_count(SoakRandom& random) {
  const double kind = random.unit();
  if (kind < 0.90) return random.whole(1, 12);
  return kind < 0.99 ? random.whole(13, 40) : random.whole(100, 400);
}

void add_placed(std::span<const Sphere> spheres, const Pose& world_from_set,
                std::vector<Sphere>& placed) {
  for (const Sphere& sphere : spheres) {
    placed.push_back({world_from_set * sphere.center, sphere.radius});
  }
}

std::optional<double> way_to_gap(std::span<const Sphere> standing, std::span<const Sphere> movers,
                                 const Vector3d& direction, double gap) {
  double farthest = -std::numeric_limits<double>::infinity();
  const Sphere *stands = nullptr, *moves = nullptr;
  for (const Sphere& one : standing) {
    for (const Sphere& other : movers) {
      const Vector3d from = other.center - one.center;
      const double passed = from.dot(direction);
      const double reach = one.radius + other.radius + gap;
      const double square = reach * reach - (from - passed * direction).squaredNorm();
      if (reach < 0.0 || square < 0.0) continue;
      const double way = std::sqrt(square) - passed;
      if (way <= farthest) continue;
      farthest = way;
      stands = &one;
      moves = &other;
    }
  }
  if (stands == nullptr) return std::nullopt;
  const auto way = pair_way(*stands, *moves, direction, gap);
  return way ? static_cast<double>(*way) : farthest;
}

ScenePair::ScenePair(SoakRandom& random)
    : size_(random_size(random)),
      place_(random.in_cube(random.chance(0.1) ? random.magnitude(1e2, 1e7) : 2.0 * size_)),
      a_(random_tree(random, random_count(random), size_)),
      b_(random_tree(random, random_count(random), size_)) {}

PosePair ScenePair::anywhere(SoakRandom& random) const {
  const Pose world_from_a(random.rotation(), place_ + random.in_cube(size_));
  const Eigen::Quaterniond turn = random.rotation();
  // The middles of the two sets, of which frames may be far away, come close to each other.
  const Vector3d middle_a = world_from_a * a_.sphere(0).center;
  const Vector3d middle_b = Pose(turn, Vector3d::Zero()) * b_.sphere(0).center;
  const double reach = a_.sphere(0).radius + b_.sphere(0).radius;
  const double way = reach * random.between(0.0, 1.3);
  return {world_from_a, Pose(turn, middle_a - middle_b + way * random.direction())};
}

std::optional<PosePair> ScenePair::at_gap(SoakRandom& random, double gap) const {
  const Pose world_from_a(random.rotation(), place_ + random.in_cube(size_));
  const Eigen::Quaterniond turn = random.rotation();
  const Vector3d direction = random.direction();

  // The way leads one sphere of b to one of a, off the middle by less than both radii.
  const auto pick = [&](const SphereTree& tree) {
    return tree.spheres()[static_cast<std::size_t>(
        random.whole(0, static_cast<int>(tree.spheres().size()) - 1))];
  };
  const Sphere from_a = pick(a_), from_b = pick(b_);
  const double off = (from_a.radius + from_b.radius + gap) * random.between(0.0, 0.99);
  const Vector3d start = world_from_a * from_a.center -
                         Pose(turn, Vector3d::Zero()) * from_b.center + off * random.direction();

  std::vector<Sphere> standing, movers;
  add_placed(a_.spheres(), world_from_a, standing);
  add_placed(b_.spheres(), Pose(turn, start), movers);
  const auto way = way_to_gap(standing, movers, direction, gap);
  if (!way) return std::nullopt;
  return PosePair{world_from_a, Pose(turn, start + *way * direction), direction};
}

}  // namespace spherule::test
