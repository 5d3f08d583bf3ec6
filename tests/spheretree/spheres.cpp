// SPDX-License-Identifier: BSD-3-Clause
#include "tests/spheretree/spheres.h"

#include <cmath>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// Calls make(i) for each sphere.
template <typename Make>
std::vector<Sphere> spheres_of(std::size_t count, const Make& make) {
  std::vector<Sphere> spheres;
  spheres.reserve(count);
  for (std::size_t i = 0; i < count; ++i) spheres.push_back(make(i));
  return spheres;
}

// Integers give exact ties: equal distances, equal coordinates, coplanar and cospherical centres.
Vector3d lattice_point(Random& random) {
  const auto coordinate = [&random] { return static_cast<double>(random.below(5)) - 2.0; };
  const double x = coordinate();
  const double y = coordinate();
  return {x, y, coordinate()};
}

std::vector<Family> usual_families(std::size_t count, Random& random) {
  return {
      {"solid", spheres_of(count,
                           [&](std::size_t) {
                             return Sphere{random.in_cube(1.0), random.between(0.0, 0.1)};
                           })},
      {"shell", spheres_of(count,
                           [&](std::size_t) {
                             return Sphere{random.direction(), 0.05};
                           })},
      {"points", spheres_of(count,
                            [&](std::size_t) {
                              return Sphere{random.in_cube(1.0), 0.0};
                            })},
      {"large radii", spheres_of(count,
                                 [&](std::size_t) {
                                   return Sphere{random.in_cube(0.1), random.between(0.5, 1.0)};
                                 })},
      {"far from the origin", spheres_of(count,
                                         [&](std::size_t) {
                                           return Sphere{
                                               Vector3d(1e6, -2e6, 3e6) + random.in_cube(1.0),
                                               random.between(0.0, 0.1)};
                                         })},
  };
}

std::vector<Family> degenerate_families(std::size_t count, Random& random) {
  return {
      {"coincident", spheres_of(count,
                                [&](std::size_t) {
                                  return Sphere{{0.1, 0.2, 0.3}, 0.7};
                                })},
      {"concentric", spheres_of(count,
                                [&](std::size_t) {
                                  return Sphere{{0.1, 0.2, 0.3}, random.unit()};
                                })},
      {"nested, touching inside", spheres_of(count,
                                             [&](std::size_t i) {
                                               const double r = 1.0 / static_cast<double>(i + 1);
                                               return Sphere{{1.0 - r, 0.0, 0.0}, r};
                                             })},
      {"line", spheres_of(count,
                          [&](std::size_t i) {
                            return Sphere{static_cast<double>(i) * Vector3d(0.1, 0.2, -0.3), 0.05};
                          })},
      {"line, halving steps",
       spheres_of(count,
                  [&](std::size_t i) {
                    return Sphere{{std::ldexp(1.0, -static_cast<int>(i % 900)), 0.0, 0.0}, 1e-3};
                  })},
      {"plane", spheres_of(count,
                           [&](std::size_t) {
                             const double x = random.between(-1.0, 1.0);
                             const double y = random.between(-1.0, 1.0);
                             return Sphere{{x, y, x + y}, random.between(0.0, 0.1)};
                           })},
      {"lattice",
       spheres_of(count,
                  [&](std::size_t) {
                    return Sphere{lattice_point(random), static_cast<double>(random.below(3))};
                  })},
      {"inside touching the unit sphere",
       spheres_of(count,
                  [&](std::size_t) {
                    const double r = random.unit();
                    return Sphere{(1.0 - r) * random.direction(), r};
                  })},
      {"a few units in the last place apart",
       spheres_of(count,
                  [&](std::size_t) {
                    return Sphere{{1.0 + 0x1p-52 * static_cast<double>(random.below(4)), 2.0, 3.0},
                                  0.5 + 0x1p-53 * static_cast<double>(random.below(4))};
                  })},
  };
}

std::vector<Family> scaled_families(std::size_t count, Random& random) {
  return {
      {"tiny", spheres_of(count,
                          [&](std::size_t) {
                            return Sphere{random.in_cube(1e-9), random.between(0.0, 1e-10)};
                          })},
      {"huge", spheres_of(count,
                          [&](std::size_t) {
                            return Sphere{random.in_cube(1e9), random.between(0.0, 1e8)};
                          })},
      {"scales from 1e-9 to 1e9",
       spheres_of(count,
                  [&](std::size_t) {
                    const double scale = std::pow(10.0, random.between(-9.0, 9.0));
                    return Sphere{random.in_cube(scale), scale * random.unit()};
                  })},
      {"squares underflow",
       spheres_of(count,
                  [&](std::size_t) {
                    return Sphere{random.in_cube(1e-200), random.between(0.0, 1e-200)};
                  })},
  };
}

}  // namespace

Eigen::Vector3d Random::direction() {
  for (;;) {
    const Vector3d v = in_cube(1.0);
    const double length = v.norm();
    if (length > 0.01 && length <= 1.0) return v / length;
  }
}

std::vector<Family> sphere_families(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Family> families;
  for (const auto make : {usual_families, degenerate_families, scaled_families}) {
    for (Family& family : make(count, random)) families.push_back(std::move(family));
  }
  return families;
}

}  // namespace spherule::test
