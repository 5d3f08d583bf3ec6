// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"

#include "base/error.h"
#include "geometry/sphere.h"

// What sources compiled with fast-math call (base/rounding.h): the inline functions, compiled
// here.

#ifdef SPHERULE_FAST_MATH
#error "The library must not be compiled with fast-math: its bounds rest on IEEE arithmetic."
#endif

namespace spherule::ieee {

double next_up(double x) {
  return spherule::next_up(x);
}

double next_down(double x) {
  return spherule::next_down(x);
}

double add_up(double a, double b) {
  return spherule::add_up(a, b);
}

double sum_up(double a, double b) {
  return spherule::sum_up(a, b);
}

double add_down(double a, double b) {
  return spherule::add_down(a, b);
}

double sub_up(double a, double b) {
  return spherule::sub_up(a, b);
}

double sub_down(double a, double b) {
  return spherule::sub_down(a, b);
}

double mul_up(double a, double b) {
  return spherule::mul_up(a, b);
}

double norm_upper(const Eigen::Vector3d& v) {
  return spherule::norm_upper(v);
}

double norm_lower(const Eigen::Vector3d& v) {
  return spherule::norm_lower(v);
}

double distance_upper(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return spherule::distance_upper(a, b);
}

double distance_lower(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return spherule::distance_lower(a, b);
}

bool is_usable_coordinate(double x) {
  return spherule::is_usable_coordinate(x);
}

bool is_usable_point(const Eigen::Vector3d& p) {
  return spherule::is_usable_point(p);
}

bool operator==(const Sphere& a, const Sphere& b) {
  return spherule::operator==(a, b);
}

bool is_usable(const Sphere& s) {
  return spherule::is_usable(s);
}

bool certainly_encloses(const Sphere& outer, const Sphere& inner) {
  return spherule::certainly_encloses(outer, inner);
}

bool certainly_contains(const Sphere& sphere, const Eigen::Vector3d& point, double reach) {
  return spherule::certainly_contains(sphere, point, reach);
}

bool possibly_overlap(const Sphere& a, const Sphere& b) {
  return spherule::possibly_overlap(a, b);
}

}  // namespace spherule::ieee

namespace spherule {

// To nearest, a quarter of the distance to the next number above 1 is rounded off, and three
// quarters are rounded up to it. Upwards, the first is not; downwards and towards zero, the second.
void require_rounding_to_nearest() {
  volatile double one = 1.0;
  volatile double quarter = 0x1p-54;
  volatile double three_quarters = 0x1.8p-53;
  const double first = one + quarter;
  const double second = one + three_quarters;
  if (first != 1.0 || second != 1.0 + 0x1p-52) {
    throw Error("rounding mode", "must be to nearest: no bound is proved for another one");
  }
}

}  // namespace spherule
