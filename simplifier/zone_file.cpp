// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/zone_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <limits>

namespace spherule {
namespace {

using Eigen::Vector3d;
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
