// SPDX-License-Identifier: BSD-3-Clause
#include "io/sphere_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "io/sphere_text.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>

namespace spherule {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::string_view kFormat = "spherule-spheres";
constexpr std::int64_t kVersion = 1;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::string_view kInfinityText = "inf";
constexpr std::string_view kMinusInfinityText = "-inf";

bool is_infinity_text(const std::string& text) {
  return text == kInfinityText || text == kMinusInfinityText;
}

// All refusals go through here, so that each names the file.
class Refusal {
 public:
  explicit Refusal(std::string file) : file_(std::move(file)) {}

  [[noreturn]] void operator()(const std::string& reason) const { throw Error(file_, reason); }

  void unless(bool good, const std::string& reason) const {
    if (!good) (*this)(reason);
  }

 private:
  std::string file_;
};

void check_depth(const CertificateRecord& record, const Refusal& refuse) {
  refuse.unless(record.uncovered_depth_lower >= 0.0 &&
                    record.uncovered_depth_lower <= record.uncovered_depth_upper,
                "certificate: \"uncovered_depth\" is not a lower and an upper bound");
}

// --- writing ---

ordered_json number(double value, const std::string& what, const Refusal& refuse) {
  refuse.unless(!std::isnan(value), what + " is not a number");
  if (std::isinf(value)) return value > 0.0 ? kInfinityText : kMinusInfinityText;
  return value;
}

ordered_json written(const CertificateRecord& record, const Refusal& refuse) {
  check_depth(record, refuse);
  const auto put = [&refuse](double value, const std::string& key) {
    return number(value, "certificate: " + key, refuse);
  };
  ordered_json certificate = ordered_json::object();
  certificate["covered"] = record.covered;
  certificate["uncovered_depth"] = {put(record.uncovered_depth_lower, "uncovered_depth"),
                                    put(record.uncovered_depth_upper, "uncovered_depth")};
  const auto put_optional = [&](const char* key, const std::optional<double>& value) {
    if (value) certificate[key] = put(*value, key);
  };
  put_optional("protrusion_over_simplified_max", record.protrusion_over_simplified_max);
  put_optional("protrusion_over_mesh_max", record.protrusion_over_mesh_max);
  if (!record.protrusion_in_zones.empty()) certificate["zones"] = ordered_json::array();
  for (const double protrusion : record.protrusion_in_zones) {
    certificate["zones"].push_back({{"protrusion_over_simplified_max", put(protrusion, "zones")}});
  }
  certificate["sphere_count"] = record.sphere_count;
  put_optional("volume_ratio", record.volume_ratio);
  put_optional("filled_volume", record.filled_volume);
  put_optional("filled_volume_error", record.filled_volume_error);
  put_optional("closing_slack", record.closing_slack);
  return certificate;
}

ordered_json written(const std::string& name, const OptionValue& value, const Refusal& refuse) {
  if (const auto* real = std::get_if<double>(&value)) {
    return number(*real, "option " + name, refuse);
  }
  if (const auto* text = std::get_if<std::string>(&value)) {
    refuse.unless(!is_infinity_text(*text),
                  "option " + name + ": the text \"" + *text + "\" stands for a number");
  }
  return std::visit([](const auto& plain) { return ordered_json(plain); }, value);
}

ordered_json written(const std::map<std::string, OptionValue>& options, const Refusal& refuse) {
  ordered_json object = ordered_json::object();
  for (const auto& [key, value] : options) object[key] = written(key, value, refuse);
  return object;
}

ordered_json written(const BodyRecord& body, const Refusal& refuse) {
  ordered_json object = ordered_json::object();
  object["name"] = body.name;
  object["sphere_count"] = body.sphere_count;
  if (body.certificate) object["certificate"] = written(*body.certificate, refuse);
  if (body.copy) {
    const Eigen::Vector3d& t = body.copy->pose.translation();
    const Eigen::Quaterniond q = body.copy->pose.rotation();
    object["copy_of"] = body.copy->of;
    object["pose"] = {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
  } else {
    object["options"] = written(body.options, refuse);
  }
  if (body.interrupted) object["interrupted"] = true;
  return object;
}

// --- reading ---

// Absent where it is false.
bool read_interrupted(const json& object, const std::string& where, const Refusal& refuse) {
  const auto found = object.find("interrupted");
  if (found == object.end()) return false;
  refuse.unless(found->is_boolean(), where + "\"interrupted\" is not true or false");
  return found->get<bool>();
}

const json& member(const json& object, const char* key, const std::string& where,
                   const Refusal& refuse) {
  const auto found = object.find(key);
  if (found == object.end()) refuse(where + ": \"" + key + "\" is missing");
  return *found;
}

double read_number(const json& value, const std::string& what, const Refusal& refuse) {
  if (value.is_string() && is_infinity_text(value.get_ref<const std::string&>())) {
    return value.get_ref<const std::string&>() == kInfinityText ? kInfinity : -kInfinity;
  }
  refuse.unless(value.is_number(), what + " is not a number");
  return value.get<double>();
}

Sphere read_sphere(const json& value, std::size_t index, const Refusal& refuse) {
  const std::string where = "sphere " + std::to_string(index);
  refuse.unless(value.is_object(), where + " is not an object");
  const json& center = member(value, "center", where, refuse);
  refuse.unless(center.is_array() && center.size() == 3, where + ": \"center\" is not [x,y,z]");
  Sphere sphere;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sphere.center[static_cast<Eigen::Index>(axis)] =
        read_number(center[axis], where + ": a coordinate", refuse);
  }
  sphere.radius =
      read_number(member(value, "radius", where, refuse), where + ": \"radius\"", refuse);
  refuse.unless(sphere.radius >= 0.0, where + ": \"radius\" is negative");
  refuse.unless(is_usable(sphere), where + ": a number is beyond 1e15");
  return sphere;
}

CertificateRecord read_certificate(const json& value, std::size_t sphere_count,
                                   const Refusal& refuse) {
  const std::string where = "certificate";
  refuse.unless(value.is_object(), where + " is not an object");
  CertificateRecord record;
  const json& covered = member(value, "covered", where, refuse);
  refuse.unless(covered.is_boolean(), where + ": \"covered\" is not true or false");
  record.covered = covered.get<bool>();
  const json& depth = member(value, "uncovered_depth", where, refuse);
  refuse.unless(depth.is_array() && depth.size() == 2,
                where + ": \"uncovered_depth\" is not [lower,upper]");
  record.uncovered_depth_lower = read_number(depth[0], where + ": \"uncovered_depth\"", refuse);
  record.uncovered_depth_upper = read_number(depth[1], where + ": \"uncovered_depth\"", refuse);
  check_depth(record, refuse);
  const auto optional = [&](const char* key) -> std::optional<double> {
    const auto found = value.find(key);
    if (found == value.end() || found->is_null()) return std::nullopt;
    return read_number(*found, where + ": \"" + key + "\"", refuse);
  };
  record.protrusion_over_simplified_max = optional("protrusion_over_simplified_max");
  record.protrusion_over_mesh_max = optional("protrusion_over_mesh_max");
  record.volume_ratio = optional("volume_ratio");
  record.filled_volume = optional("filled_volume");
  record.filled_volume_error = optional("filled_volume_error");
  record.closing_slack = optional("closing_slack");
  if (const auto zones = value.find("zones"); zones != value.end()) {
    refuse.unless(zones->is_array(), where + ": \"zones\" is not a list");
    for (const json& zone : *zones) {
      refuse.unless(zone.is_object(), where + ": a zone is not an object");
      record.protrusion_in_zones.push_back(
          read_number(member(zone, "protrusion_over_simplified_max", where + ": zone", refuse),
                      where + ": zone", refuse));
    }
  }
  const json& count = member(value, "sphere_count", where, refuse);
  refuse.unless(count.is_number_unsigned() && count.get<std::uint64_t>() == sphere_count,
                where + ": \"sphere_count\" is not the number of spheres in the file");
  record.sphere_count = sphere_count;
  return record;
}

OptionValue read_option(const std::string& name, const json& value, const Refusal& refuse) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_number_unsigned()) {
    refuse.unless(value.get<std::uint64_t>() <=
                      static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()),
                  "option " + name + " is too large");
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  refuse.unless(value.is_string(),
                "option " + name + " is neither a number, a text nor a truth value");
  const auto& text = value.get_ref<const std::string&>();
  if (is_infinity_text(text)) return read_number(value, "option " + name, refuse);
  return text;
}

std::map<std::string, OptionValue> read_options(const json& object, const std::string& where,
                                                const Refusal& refuse) {
  std::map<std::string, OptionValue> options;
  const auto found = object.find("options");
  if (found == object.end() || found->is_null()) return options;
  refuse.unless(found->is_object(), where + "\"options\" is not an object");
  for (const auto& [key, option] : found->items()) options[key] = read_option(key, option, refuse);
  return options;
}

Pose read_pose(const json& value, const std::string& where, const Refusal& refuse) {
  refuse.unless(value.is_array() && value.size() == 7, where + ": \"pose\" is not seven numbers");
  std::array<double, 7> p{};
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = read_number(value[i], where + ": pose", refuse);
  try {
    return {Eigen::Quaterniond(p[6], p[3], p[4], p[5]), Eigen::Vector3d(p[0], p[1], p[2])};
  } catch (const Error& error) {
    refuse(where + ": \"pose\" is not usable: " + error.what());
  }
}

BodyRecord read_body(const json& value, std::span<const BodyRecord> before, const Refusal& refuse) {
  const std::string where = "body " + std::to_string(before.size());
  refuse.unless(value.is_object(), where + " is not an object");
  BodyRecord body;
  const json& name = member(value, "name", where, refuse);
  refuse.unless(name.is_string() && !name.get_ref<const std::string&>().empty(),
                where + ": \"name\" is not a text");
  body.name = name.get<std::string>();
  const json& count = member(value, "sphere_count", where, refuse);
  refuse.unless(count.is_number_unsigned(), where + ": \"sphere_count\" is not a number");
  body.sphere_count = count.get<std::size_t>();
  const auto certificate = value.find("certificate");
  if (certificate != value.end() && !certificate->is_null()) {
    body.certificate = read_certificate(*certificate, body.sphere_count, refuse);
  }
  body.options = read_options(value, where + ": ", refuse);
  body.interrupted = read_interrupted(value, where + ": ", refuse);
  if (const auto of = value.find("copy_of"); of != value.end()) {
    refuse.unless(of->is_number_unsigned() && of->get<std::uint64_t>() < before.size() &&
                      !before[of->get<std::size_t>()].copy,
                  where + ": \"copy_of\" is not the number of a body before it that is no copy");
    body.copy = BodyCopy{of->get<std::size_t>(),
                         read_pose(member(value, "pose", where, refuse), where, refuse)};
    refuse.unless(body.sphere_count == before[body.copy->of].sphere_count,
                  where + ": has another number of spheres than the body that it is a copy of");
  }
  return body;
}

std::vector<BodyRecord> read_bodies(const json& list, std::size_t sphere_count,
                                    const Refusal& refuse) {
  refuse.unless(list.is_array(), "\"bodies\" is not a list");
  std::vector<BodyRecord> bodies;
  std::size_t left = sphere_count;
  for (const json& value : list) {
    bodies.push_back(read_body(value, bodies, refuse));
    refuse.unless(bodies.back().sphere_count <= left, "its bodies have more spheres than it holds");
    left -= bodies.back().sphere_count;
  }
  refuse.unless(bodies.empty() || left == 0, "it holds spheres of no body");
  return bodies;
}

}  // namespace

// JSON with one sphere a line, so that files can be compared line by line.
std::string internal::encode_spheres(const SphereFile& file, const std::string& name) {
  const Refusal refuse(name);
  std::string text = "{\"format\":\"" + std::string(kFormat) +
                     "\",\"version\":" + std::to_string(kVersion) + ",\n\"spheres\":[";
  for (std::size_t i = 0; i < file.spheres.size(); ++i) {
    const Sphere& s = file.spheres[i];
    refuse.unless(is_usable(s), "sphere " + std::to_string(i) + " is not usable");
    const ordered_json center = {s.center.x(), s.center.y(), s.center.z()};
    text += i == 0 ? "\n" : ",\n";
    text += "{\"center\":" + center.dump() + ",\"radius\":" + ordered_json(s.radius).dump() + "}";
  }
  text += "\n]";
  if (file.certificate) {
    refuse.unless(file.certificate->sphere_count == file.spheres.size(),
                  "the certificate is not for this number of spheres");
    text += ",\n\"certificate\":" + written(*file.certificate, refuse).dump();
  }
  std::size_t in_bodies = 0;
  for (const BodyRecord& body : file.bodies) in_bodies += body.sphere_count;
  refuse.unless(file.bodies.empty() || in_bodies == file.spheres.size(),
                "the bodies have not as many spheres as the file");
  try {
    text += ",\n\"options\":" + written(file.options, refuse).dump();
    if (file.interrupted) text += ",\n\"interrupted\":true";
    if (!file.bodies.empty()) text += ",\n\"bodies\":[";
    for (std::size_t i = 0; i < file.bodies.size(); ++i) {
      text += (i == 0 ? "\n" : ",\n") + written(file.bodies[i], refuse).dump();
    }
    if (!file.bodies.empty()) text += "\n]";
  } catch (const json::exception&) {
    refuse("an option or a name is not valid UTF-8");
  }
  return text + "}\n";
}

SphereFile internal::decode_spheres(std::string_view text, const std::string& name) {
  const Refusal refuse(name);
  const json document = internal::parse_json<json>(text, refuse);
  refuse.unless(document.is_object(), "is not an object");
  const auto format = document.find("format");
  refuse.unless(format != document.end() && *format == kFormat,
                "is not of format \"" + std::string(kFormat) + "\"");
  const json& version = member(document, "version", "file", refuse);
  refuse.unless(version.is_number_unsigned() && version.get<std::uint64_t>() >= 1,
                "\"version\" is not a positive integer");
  refuse.unless(version.get<std::uint64_t>() <= kVersion,
                "has format version " + version.dump() + "; this program reads versions up to " +
                    std::to_string(kVersion));
  const json& spheres = member(document, "spheres", "file", refuse);
  refuse.unless(spheres.is_array(), "\"spheres\" is not a list");

  SphereFile file;
  file.spheres.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    file.spheres.push_back(read_sphere(spheres[i], i, refuse));
  }
  const auto certificate = document.find("certificate");
  if (certificate != document.end() && !certificate->is_null()) {
    file.certificate = read_certificate(*certificate, file.spheres.size(), refuse);
  }
  file.options = read_options(document, "", refuse);
  file.interrupted = read_interrupted(document, "", refuse);
  if (const auto bodies = document.find("bodies"); bodies != document.end()) {
    file.bodies = read_bodies(*bodies, file.spheres.size(), refuse);
  }
  return file;
}

void save_spheres(const SphereFile& file, const std::filesystem::path& path) {
  write_file_atomically(path, internal::encode_spheres(file, path.string()));
}

SphereFile load_spheres(const std::filesystem::path& path) {
  return internal::decode_spheres(read_file(path), path.string());
}

}  // namespace spherule
