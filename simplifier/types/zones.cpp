// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/types/zones.h"

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "base/rounding.h"
#include "geometry/point_triangle.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string>

namespace spherule {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// A segment is a triangle with two equal corners.
TriangleDistance to_axis(const ZoneCapsule& capsule, const Vector3d& point) {
  return point_triangle_distance(point, capsule.from, capsule.to, capsule.to);
}

struct DistanceLower {
  const Vector3d& point;

  double operator()(const Sphere& sphere) const {
    return std::max(0.0, sub_down(distance_lower(point, sphere.center), sphere.radius));
  }
  double operator()(const AlignedBox3d& box) const {
    Vector3d gap;
    for (int axis = 0; axis < 3; ++axis) {
      gap[axis] = std::max(
          {0.0, sub_down(box.min()[axis], point[axis]), sub_down(point[axis], box.max()[axis])});
    }
    return norm_lower(gap);
  }
  double operator()(const ZoneCapsule& capsule) const {
    return std::max(0.0, sub_down(to_axis(capsule, point).lower, capsule.radius));
  }
};

struct Contains {
  const Vector3d& point;
  double reach;

  bool operator()(const Sphere& sphere) const { return certainly_contains(sphere, point, reach); }
  bool operator()(const AlignedBox3d& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double low = reach == 0.0 ? point[axis] : sub_down(point[axis], reach);
      const double high = reach == 0.0 ? point[axis] : add_up(point[axis], reach);
      if (!(low >= box.min()[axis] && high <= box.max()[axis])) return false;
    }
    return true;
  }
  bool operator()(const ZoneCapsule& capsule) const {
    return add_up(to_axis(capsule, point).upper, reach) <= capsule.radius;
  }
};

struct Bounding {
  AlignedBox3d operator()(const Sphere& sphere) const {
    return about(sphere.center, sphere.radius);
  }
  AlignedBox3d operator()(const AlignedBox3d& box) const { return box; }
  AlignedBox3d operator()(const ZoneCapsule& capsule) const {
    return about(capsule.from, capsule.radius).merged(about(capsule.to, capsule.radius));
  }

  static AlignedBox3d about(const Vector3d& center, double radius) {
    AlignedBox3d box;
    for (int axis = 0; axis < 3; ++axis) {
      box.min()[axis] = sub_down(center[axis], radius);
      box.max()[axis] = add_up(center[axis], radius);
    }
    return box;
  }
};

struct IsUsable {
  bool operator()(const Sphere& sphere) const { return is_usable(sphere); }
  bool operator()(const AlignedBox3d& box) const {
    return is_usable_point(box.min()) && is_usable_point(box.max()) &&
           (box.min().array() <= box.max().array()).all();
  }
  bool operator()(const ZoneCapsule& capsule) const {
    return is_usable(Sphere{capsule.from, capsule.radius}) && is_usable_point(capsule.to);
  }
};

bool equal_shapes(const ZoneShape& a, const ZoneShape& b) {
  if (a.index() != b.index()) return false;
  if (const auto* box = std::get_if<AlignedBox3d>(&a)) {
    const auto& other = std::get<AlignedBox3d>(b);
    return box->min() == other.min() && box->max() == other.max();
  }
  if (const auto* sphere = std::get_if<Sphere>(&a)) return *sphere == std::get<Sphere>(b);
  return std::get<ZoneCapsule>(a) == std::get<ZoneCapsule>(b);
}

}  // namespace

bool operator==(const Zone& a, const Zone& b) {
  return equal_shapes(a.shape, b.shape) && a.max_error == b.max_error &&
         a.min_external_diameter == b.min_external_diameter;
}

double distance_lower(const ZoneShape& shape, const Vector3d& point) {
  return std::visit(DistanceLower{point}, shape);
}

bool certainly_contains(const ZoneShape& shape, const Vector3d& point, double reach) {
  return std::visit(Contains{point, reach}, shape);
}

AlignedBox3d bounds(const ZoneShape& shape) {
  return std::visit(Bounding{}, shape);
}

void check_zones(std::span<const Zone> zones, double max_error, double min_external_diameter) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    const std::string subject = "zone " + std::to_string(i);
    if (!std::visit(IsUsable{}, zone.shape)) {
      throw Error(subject,
                  "the shape has a number beyond 1e15, a negative radius, or a least "
                  "corner above the greatest");
    }
    if (!zone.max_error && !zone.min_external_diameter) {
      throw Error(subject, "has neither a max error nor a min external diameter of its own");
    }
    const auto check = [&](const char* name, const std::optional<double>& value, double elsewhere) {
      if (!value) return;
      if (!(*value > 0.0 && *value <= kMaxCoordinate)) {
        throw Error(subject, std::string("the ") + name + " must be positive and finite");
      }
      if (*value > elsewhere) {
        throw Error(subject, std::string("the ") + name + " is above the one that holds elsewhere");
      }
    };
    check("max error", zone.max_error, max_error);
    check("min external diameter", zone.min_external_diameter, min_external_diameter);
  }
}

double tightest_error(std::span<const Zone> zones, double max_error) {
  for (const Zone& zone : zones) {
    if (zone.max_error) max_error = std::min(max_error, *zone.max_error);
  }
  return max_error;
}

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "spherule-zones";
constexpr std::int64_t kVersion = 1;

// One JSON object, all keys of which have to be known; `where` names it in an Error.
class Reader {
 public:
  Reader(const Json& object, std::string subject, std::string where,
         std::initializer_list<std::string_view> known)
      : object_(object), subject_(std::move(subject)), where_(std::move(where)) {
    if (!object.is_object()) fail("is not an object");
    for (const auto& [key, value] : object.items()) {
      if (std::ranges::find(known, key) == known.end()) fail("unknown key \"" + key + "\"");
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(subject_, where_ + ": " + reason);
  }

  const Json& member(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) fail(std::string("\"") + key + "\" is missing");
    return *found;
  }

  std::string text(const char* key) const {
    const Json& value = member(key);
    if (!value.is_string()) fail(std::string("\"") + key + "\" is not a text");
    return value.get<std::string>();
  }

  double number(const char* key) const { return number(member(key), key); }

  std::optional<double> number_if_there(const char* key) const {
    if (!object_.contains(key)) return std::nullopt;
    return number(key);
  }

  Vector3d point(const char* key) const {
    const Json& value = member(key);
    if (!value.is_array() || value.size() != 3) {
      fail(std::string("\"") + key + "\" is not [x,y,z]");
    }
    return {number(value[0], key), number(value[1], key), number(value[2], key)};
  }

 private:
  double number(const Json& value, const char* key) const {
    if (!value.is_number()) fail(std::string("\"") + key + "\" is not a number");
    return value.get<double>();
  }

  const Json& object_;
  std::string subject_;
  std::string where_;
};

ZoneShape read_sphere(const Json& entry, const std::string& subject, const std::string& where) {
  const Reader read(entry, subject, where,
                    {"shape", "center", "radius", "max_error", "min_external"});
  return Sphere{read.point("center"), read.number("radius")};
}

ZoneShape read_box(const Json& entry, const std::string& subject, const std::string& where) {
  const Reader read(entry, subject, where, {"shape", "min", "max", "max_error", "min_external"});
  return Eigen::AlignedBox3d(read.point("min"), read.point("max"));
}

ZoneShape read_capsule(const Json& entry, const std::string& subject, const std::string& where) {
  const Reader read(entry, subject, where,
                    {"shape", "from", "to", "radius", "max_error", "min_external"});
  return ZoneCapsule{read.point("from"), read.point("to"), read.number("radius")};
}

Zone read_zone(const Json& entry, const std::string& subject, const std::string& where) {
  const Reader read(
      entry, subject, where,
      {"shape", "center", "radius", "min", "max", "from", "to", "max_error", "min_external"});
  Zone zone;
  const std::string shape = read.text("shape");
  if (shape == "ball") {
    zone.shape = read_sphere(entry, subject, where);
  } else if (shape == "box") {
    zone.shape = read_box(entry, subject, where);
  } else if (shape == "capsule") {
    zone.shape = read_capsule(entry, subject, where);
  } else {
    read.fail("unknown shape \"" + shape + "\": ball, box or capsule");
  }
  zone.max_error = read.number_if_there("max_error");
  zone.min_external_diameter = read.number_if_there("min_external");
  return zone;
}

Json list(const Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

struct WriteShape {
  Json operator()(const Sphere& sphere) const {
    return {{"shape", "ball"}, {"center", list(sphere.center)}, {"radius", sphere.radius}};
  }
  Json operator()(const Eigen::AlignedBox3d& box) const {
    return {{"shape", "box"}, {"min", list(box.min())}, {"max", list(box.max())}};
  }
  Json operator()(const ZoneCapsule& capsule) const {
    return {{"shape", "capsule"},
            {"from", list(capsule.from)},
            {"to", list(capsule.to)},
            {"radius", capsule.radius}};
  }
};

internal::JsonDocument<Json> parsed(std::string_view text, const std::string& subject) {
  return internal::parse_json<Json>(
      text, [&](const std::string& reason) { throw Error(subject, reason); });
}

}  // namespace

std::vector<Zone> parse_zones(std::string_view text, const std::string& subject) {
  const auto document = parsed(text, subject);
  const Reader read(document, subject, "file", {"format", "version", "zones"});
  if (read.text("format") != kFormat) read.fail("is not of format \"spherule-zones\"");
  const Json& version = read.member("version");
  if (!version.is_number_integer() || version != kVersion) {
    read.fail("has a version that this program does not read; it reads version 1");
  }
  const Json& entries = read.member("zones");
  if (!entries.is_array()) read.fail("\"zones\" is not a list");
  std::vector<Zone> zones;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    zones.push_back(read_zone(entries[i], subject, "zone " + std::to_string(i)));
  }
  constexpr double kAny = std::numeric_limits<double>::infinity();
  try {
    check_zones(zones, kAny, kAny);
  } catch (const Error& error) {
    throw Error(subject, error.what());
  }
  return zones;
}

std::vector<Zone> read_zones(const std::filesystem::path& path) {
  return parse_zones(read_file(path), path.string());
}

std::string zones_text(std::span<const Zone> zones) {
  Json entries = Json::array();
  for (const Zone& zone : zones) {
    Json entry = std::visit(WriteShape{}, zone.shape);
    if (zone.max_error) entry["max_error"] = *zone.max_error;
    if (zone.min_external_diameter) entry["min_external"] = *zone.min_external_diameter;
    entries.push_back(std::move(entry));
  }
  return Json{{"format", kFormat}, {"version", kVersion}, {"zones", entries}}.dump();
}

}  // namespace spherule
