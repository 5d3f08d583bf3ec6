// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <iostream>
#include <random>
#include <spherule/collide/collide.h>
#include <spherule/geometry/sphere.h>
#include <spherule/spheretree/build.h>
#include <vector>

// What is compared with, in exact.cpp: compiled without -ffast-math, in long double, so that bounds
// that are wrong by a double's rounding are found.
namespace exact {

using Point = std::array<double, 3>;

// Numbers that a compiler does not know.
double not_a_number();
double infinity();

// Whether subnormal doubles are flushed to zero.
bool flushes_to_zero();

// Whether the distance of the points, plus `add`, is within the bounds.
bool is_at_least(const Point& a, const Point& b, double lower);
bool is_at_most(const Point& a, const Point& b, double add, double upper);

// Whether `sum` is not below, and not above, a + b (which is exact in long double for numbers of
// similar size).
bool is_not_below(double sum, double a, double b);
bool is_not_above(double sum, double a, double b);

}  // namespace exact

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (!holds) std::cout << "wrong: " << what << "\n";
  if (!holds) ++failures;
}

exact::Point of(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

void unusable_numbers() {
  const double none = exact::not_a_number(), infinite = exact::infinity();
  expect(!spherule::is_usable_coordinate(none), "NaN is refused");
  expect(!spherule::is_usable_coordinate(infinite), "infinity is refused");
  expect(!spherule::is_usable_point({0.0, none, 0.0}), "a point with NaN is refused");
  expect(!spherule::is_usable({.center = {0.0, 0.0, 0.0}, .radius = none}), "a radius is refused");
  expect(
      !spherule::certainly_contains({.center = {0.0, 0.0, 0.0}, .radius = 1.0}, {none, 0.0, 0.0}),
      "nothing contains NaN");
  expect(!(spherule::Sphere{.radius = none} == spherule::Sphere{.radius = none}),
         "NaN equals nothing");
}

// Points `size` from each other, in all directions.
void bounds(double size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> in(-size, size);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d a(in(random), in(random), in(random));
    const Eigen::Vector3d b(in(random), in(random), in(random));
    const double radius = std::abs(in(random));
    expect(exact::is_at_least(of(a), of(b), spherule::distance_lower(a, b)), "distance_lower");
    expect(exact::is_at_most(of(a), of(b), 0.0, spherule::distance_upper(a, b)), "distance_upper");
    expect(exact::is_not_below(spherule::add_up(a.x(), b.y()), a.x(), b.y()), "add_up");
    expect(exact::is_not_above(spherule::add_down(a.x(), b.y()), a.x(), b.y()), "add_down");
    // The smallest radius that is said to be enough.
    double outer = (spherule::distance_upper(a, b) + radius) * (1.0 + 0x1p-50);
    while (spherule::certainly_encloses({.center = a, .radius = outer},
                                        {.center = b, .radius = radius})) {
      expect(exact::is_at_most(of(a), of(b), radius, outer), "certainly_encloses");
      outer *= 1.0 - 0x1p-51;
    }
  }
}

// Spheres that touch are never called free: the compiled library runs with subnormal numbers
// flushed to zero, too, and those of single precision are larger than some of these.
void contacts(double size) {
  std::vector<spherule::Sphere> row;
  for (int i = 0; i < 10; ++i) row.push_back({.center = {2.0 * size * i, 0, 0}, .radius = size});
  const spherule::SphereTree tree = spherule::build_tree(row);
  const auto at = [&](double gap) {
    return spherule::Pose::from_translation({0.0, (2.0 + gap) * size, 0.0});
  };
  expect(spherule::collides(tree, {}, tree, at(0.0)), "spheres that touch");
  expect(!spherule::collides(tree, {}, tree, at(0.1)), "spheres that do not touch");
}

}  // namespace

int main() {
  // Where the linker does not make it so, there is nothing to see of it.
  std::cout << "subnormal numbers are flushed: " << exact::flushes_to_zero() << "\n";
  unusable_numbers();
  std::mt19937_64 random(7);
  for (const double size : {1.0, 1e12, 1e-100, 1e-136}) bounds(size, random);
  for (const double size : {1.0, 1e-20, 1e-40, 1e-136}) contacts(size);
  return failures == 0 ? 0 : 1;
}
