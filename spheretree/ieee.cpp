// SPDX-License-Identifier: BSD-3-Clause
// What sources compiled with fast-math call (spheretree/rounding.h): the inline functions, compiled
// here.
#include "spheretree/sphere.h"

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
