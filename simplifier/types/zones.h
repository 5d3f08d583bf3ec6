// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Parts of space in which E or D is smaller, and their files.
//
// @code{.cpp}
// #include <spherule/simplifier/types/zones.h>
// #include <cassert>
//
// const spherule::Zone zone{.shape = spherule::Sphere{{0, 0, 0}, 2}, .max_error = 0.1};
// const std::vector<spherule::Zone> zones{zone};
// spherule::check_zones(zones, 0.5, 2.0);  // throws Error unless they are usable with this E and D
// assert(spherule::tightest_error(zones, 0.5) == 0.1);
// @endcode

#include "geometry/sphere.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spherule {

// All points within `radius` of the segment between two points; a radius of 0 is the segment.
struct ZoneCapsule {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// Equal numbers, not equal sets.
inline bool operator==(const ZoneCapsule& a, const ZoneCapsule& b) {
  return a.from == b.from && a.to == b.to && a.radius == b.radius;
}

// Closed and convex, which the rule for steps of the flood rests on.
using ZoneShape = std::variant<Sphere, Eigen::AlignedBox3d, ZoneCapsule>;

// A part of space in which E or D is smaller than elsewhere. Where zones overlap, the smallest
// value counts.
struct Zone {
  ZoneShape shape;
  // e: every point of the union of the spheres that lies in the zone is at most this far from S. At
  // most E.
  std::optional<double> max_error = std::nullopt;
  // d: a sphere of diameter d, instead of D, is small enough to be an external sphere where its
  // centre lies in the zone. At most D. So that something gets in, the zone has to hold the centres
  // of spheres of diameter D beside it, not only the detail that is to be kept: let it reach D / 2
  // out of the surface, and a few grid steps more.
  std::optional<double> min_external_diameter = std::nullopt;
};

// Equal numbers, not equal sets.
bool operator==(const Zone& a, const Zone& b);

// Never more than the distance of `point` to the shape, and 0 in it.
double distance_lower(const ZoneShape& shape, const Eigen::Vector3d& point);
// True only if the sphere of radius `reach` about `point` is a subset of the shape; false within
// rounding of the limit.
bool certainly_contains(const ZoneShape& shape, const Eigen::Vector3d& point, double reach = 0.0);
// A box that contains the shape.
Eigen::AlignedBox3d bounds(const ZoneShape& shape);

// Throws Error with the subject "zone N", N counted from 0, for a zone that cannot be used: numbers
// that are not finite or too large, a negative radius, a box that is inside out; no value at all;
// values that are not positive, or above the `max_error` E and the `min_external_diameter` D that
// hold elsewhere. Infinity for these tests the rest.
void check_zones(std::span<const Zone> zones, double max_error, double min_external_diameter);

// The smallest E of all zones and the given one.
double tightest_error(std::span<const Zone> zones, double max_error);

// Zones as text, in files of their own and among the options that are stored beside spheres.
//
// @code{.cpp}
// const std::vector<spherule::Zone> zones{
//     {.shape = spherule::Sphere{{0, 0, 0}, 2}, .max_error = 0.1}};
// assert(spherule::parse_zones(spherule::zones_text(zones), "zones") == zones);
// @endcode

// The file of `fit --zones`, lengths in output units:
//   {"format":"spherule-zones","version":1,"zones":[
//     {"shape":"ball","center":[x,y,z],"radius":r,"max_error":e,"min_external":d},
//     {"shape":"box","min":[x,y,z],"max":[x,y,z],"max_error":e},
//     {"shape":"capsule","from":[x,y,z],"to":[x,y,z],"radius":r,"min_external":d}]}
// Throws Error naming file, entry and reason for everything else: a key that is not known, missing
// or there twice, a value of a wrong type, a zone that check_zones() refuses.
std::vector<Zone> read_zones(const std::filesystem::path& path);

// Zones from the text of a file as read_zones() reads it, which `subject` names in errors.
std::vector<Zone> parse_zones(std::string_view text, const std::string& subject);
// Compact text of the zones, from which parse_zones() gets them back bit for bit.
std::string zones_text(std::span<const Zone> zones);

}  // namespace spherule
