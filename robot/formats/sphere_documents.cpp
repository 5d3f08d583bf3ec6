// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_documents.h"

#include "base/error.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace spherule::internal {
void SphereGatherer::refuse(const std::string& place, const std::string& reason) const {
  throw Error(file_, place.empty() ? reason : place + ": " + reason);
}

void SphereGatherer::begin_link(const std::string& name, const std::string& place) {
  take_name(name, place);
  unless(links_.insert(name).second, place, "the link \"" + name + "\" is there twice");
  spheres.links.push_back({name, {}});
}

void SphereGatherer::add(const Eigen::Vector3d& center, double radius, const std::string& place) {
  unless(left_ > 0, place, "aliases make more spheres than the file has characters");
  --left_;
  const Sphere sphere{center, radius};
  if (radius <= 0.0) {
    leave_out(spheres.links.back().link, sphere);
    return;
  }
  unless(is_usable(sphere), place, "a number is beyond 1e15");
  spheres.links.back().spheres.push_back(sphere);
}

void SphereGatherer::leave_out(const std::string& link, const Sphere& sphere) {
  ++spheres.switched_off;
  left_out[link].push_back(sphere);
}

void SphereGatherer::take(std::size_t count, const std::string& place) const {
  unless(count <= names_left_, place, "aliases make far more names than the file has characters");
  names_left_ -= count;
}

void SphereGatherer::take_name(const std::string& name, const std::string& place) const {
  // The place may hold the name.
  unless(name.size() <= kLongestName, place.size() <= kLongestName ? place : std::string(),
         "the name of a link has more than " + std::to_string(kLongestName) + " bytes");
  unless(name.size() <= name_bytes_left_, place,
         "aliases make far more names than the file has characters");
  name_bytes_left_ -= name.size();
}

void SphereGatherer::ignore(const std::string& link_a, const std::string& link_b,
                            const std::string& place) {
  take_name(link_a, place);
  take_name(link_b, place);
  if (link_a == link_b || !ignored_.insert(std::minmax(link_a, link_b)).second) return;
  spheres.self_collision_ignore.push_back({link_a, link_b, {}});
}

// With u = 2^-53: sines and cosines are within 1 u of values of at most 1 (2 u for a library that
// rounds less well), so that an entry of the product of three rotations, a sum of two products of
// at most three factors, is within 16 u; a row of it times the centre within 32 u of the centre's
// norm, the three rows within 56 u of it, and the sum with the translation adds 1 u of both. Half a
// dozen more u for the bounds' own rounding.
Sphere moved_sphere(const Sphere& sphere, const Eigen::Vector3d& roll_pitch_yaw,
                    const Eigen::Vector3d& translation) {
  if (sphere.center.isZero(0.0)) return {translation, sphere.radius};  // exact, however it turns
  const Eigen::Vector3d& angles = roll_pitch_yaw;
  const double sr = std::sin(angles.x()), cr = std::cos(angles.x());
  const double sp = std::sin(angles.y()), cp = std::cos(angles.y());
  const double sy = std::sin(angles.z()), cy = std::cos(angles.z());
  Eigen::Matrix3d rotation;
  rotation << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,          //
      -sp, cp * sr, cp * cr;
  const double error =
      64.0 * kUnitRoundoff * (norm_upper(sphere.center) + norm_upper(translation)) + kUnderflow;
  return {rotation * sphere.center + translation, add_up(sphere.radius, error)};
}

}  // namespace spherule::internal
