// SPDX-License-Identifier: BSD-3-Clause
#include "io/sphere_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/json.h"
#include "io/sphere_text.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

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

constexpr const char* kNoDepth = "\"uncovered_depth\" is not a lower and an upper bound";

bool is_depth(const CertificateRecord& record) {
  return record.uncovered_depth_lower >= 0.0 &&
         record.uncovered_depth_lower <= record.uncovered_depth_upper;
}

constexpr const char* kProtrusionKey = "protrusion_over_simplified_max";

// Numbers of a certificate that may be absent, in the order in which they are written: two, then,
// after the zones and the number of spheres, the others.
constexpr std::pair<const char*, std::optional<double> CertificateRecord::*> kOptionalNumbers[] = {
    {kProtrusionKey, &CertificateRecord::protrusion_over_simplified_max},
    {"protrusion_over_mesh_max", &CertificateRecord::protrusion_over_mesh_max},
    {"volume_ratio", &CertificateRecord::volume_ratio},
    {"filled_volume", &CertificateRecord::filled_volume},
    {"filled_volume_error", &CertificateRecord::filled_volume_error},
    {"closing_slack", &CertificateRecord::closing_slack}};

// --- writing ---

ordered_json number(double value, const std::string& what, const Refusal& refuse) {
  refuse.unless(!std::isnan(value), what + " is not a number");
  if (std::isinf(value)) return value > 0.0 ? kInfinityText : kMinusInfinityText;
  return value;
}

ordered_json written(const CertificateRecord& record, const Refusal& refuse) {
  refuse.unless(is_depth(record), std::string("certificate: ") + kNoDepth);
  const auto put = [&refuse](double value, const std::string& key) {
    return number(value, "certificate: " + key, refuse);
  };
  ordered_json certificate = ordered_json::object();
  certificate["covered"] = record.covered;
  certificate["uncovered_depth"] = {put(record.uncovered_depth_lower, "uncovered_depth"),
                                    put(record.uncovered_depth_upper, "uncovered_depth")};
  const auto put_optional = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto& [key, member] = kOptionalNumbers[i];
      if (record.*member) certificate[key] = put(*(record.*member), key);
    }
  };
  put_optional(0, 2);
  if (!record.protrusion_in_zones.empty()) certificate["zones"] = ordered_json::array();
  for (const double protrusion : record.protrusion_in_zones) {
    certificate["zones"].push_back({{kProtrusionKey, put(protrusion, "zones")}});
  }
  certificate["sphere_count"] = record.sphere_count;
  put_optional(2, std::size(kOptionalNumbers));
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

using Value = internal::JsonValue<json>;

// Absent where it is false.
bool read_interrupted(const Value& object) {
  const auto found = object.find("interrupted");
  return found && found->truth();
}

double read_number(const Value& value) {
  const json& plain = value.json();
  if (plain == kInfinityText) return kInfinity;
  return plain == kMinusInfinityText ? -kInfinity : value.number();
}

template <std::size_t kCount>
std::array<double, kCount> read_numbers(const Value& list, const char* what) {
  list.expect(list.json().is_array() && list.json().size() == kCount, what);
  std::array<double, kCount> numbers{};
  for (std::size_t i = 0; i < kCount; ++i) numbers[i] = read_number(list.part(list.json()[i]));
  return numbers;
}

std::size_t read_count(const Value& value) {
  value.expect(value.json().is_number_unsigned(), "is not a number");
  return value.json().get<std::size_t>();
}

Sphere read_sphere(const Value& value) {
  Sphere sphere;
  sphere.center = Eigen::Vector3d(read_numbers<3>(value.at("center"), "is not [x,y,z]").data());
  const Value radius = value.at("radius");
  sphere.radius = read_number(radius);
  radius.expect(sphere.radius >= 0.0, "is negative");
  value.unless(is_usable(sphere), "a number is beyond 1e15");
  return sphere;
}

CertificateRecord read_certificate(const Value& value, std::size_t sphere_count) {
  CertificateRecord record;
  record.covered = value.at("covered").truth();
  const auto [lower, upper] = read_numbers<2>(value.at("uncovered_depth"), "is not [lower,upper]");
  record.uncovered_depth_lower = lower;
  record.uncovered_depth_upper = upper;
  value.unless(is_depth(record), kNoDepth);
  for (const auto& [key, member] : kOptionalNumbers) {
    const auto found = value.find(key);
    if (found && !found->json().is_null()) record.*member = read_number(*found);
  }
  if (const auto zones = value.find("zones")) {
    zones->each(zones->place() + " ", [&](const Value& zone) {
      record.protrusion_in_zones.push_back(read_number(zone.at(kProtrusionKey)));
    });
  }
  const Value count = value.at("sphere_count");
  count.expect(count.json().is_number_unsigned() && count.json() == sphere_count,
               "is not the number of spheres in the file");
  record.sphere_count = sphere_count;
  return record;
}

std::optional<CertificateRecord> certificate_if_there(const Value& object,
                                                      std::size_t sphere_count) {
  const auto found = object.find("certificate");
  if (!found || found->json().is_null()) return std::nullopt;
  return read_certificate(*found, sphere_count);
}

OptionValue read_option(const std::string& name, const Value& object, const json& value) {
  const auto refuse = [&](const char* reason) { object.refuse("option " + name + reason); };
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_float()) return value.get<double>();
  if (value.is_number_unsigned() && !std::in_range<std::int64_t>(value.get<std::uint64_t>())) {
    refuse(" is too large");
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_string()) refuse(" is neither a number, a text nor a truth value");
  const auto& text = value.get_ref<const std::string&>();
  if (is_infinity_text(text)) return read_number(object.part(value));
  return text;
}

std::map<std::string, OptionValue> read_options(const Value& object) {
  std::map<std::string, OptionValue> options;
  const auto found = object.find("options");
  if (!found || found->json().is_null()) return options;
  found->expect(found->json().is_object(), "is not an object");
  for (const auto& [key, option] : found->json().items()) {
    options[key] = read_option(key, object, option);
  }
  return options;
}

Pose read_pose(const Value& value) {
  const auto p = read_numbers<7>(value, "is not seven numbers");
  try {
    return {Eigen::Quaterniond(p[6], p[3], p[4], p[5]), Eigen::Vector3d(p[0], p[1], p[2])};
  } catch (const Error& error) {
    value.blame(std::string("is not usable: ") + error.what());
  }
}

BodyRecord read_body(const Value& value, std::span<const BodyRecord> before) {
  BodyRecord body;
  const Value name = value.at("name");
  body.name = name.text();
  name.expect(!body.name.empty(), "is not a text");
  body.sphere_count = read_count(value.at("sphere_count"));
  body.certificate = certificate_if_there(value, body.sphere_count);
  body.options = read_options(value);
  body.interrupted = read_interrupted(value);
  if (const auto of = value.find("copy_of")) {
    of->expect(of->json().is_number_unsigned() && of->json() < before.size() &&
                   !before[of->json().get<std::size_t>()].copy,
               "is not the number of a body before it that is no copy");
    body.copy = BodyCopy{of->json().get<std::size_t>(), read_pose(value.at("pose"))};
    value.unless(body.sphere_count == before[body.copy->of].sphere_count,
                 "has another number of spheres than the body that it is a copy of");
  }
  return body;
}

std::vector<BodyRecord> read_bodies(const Value& list, std::size_t sphere_count) {
  std::vector<BodyRecord> bodies;
  std::size_t left = sphere_count;
  list.each("body ", [&](const Value& value) {
    bodies.push_back(read_body(value, bodies));
    list.unless(bodies.back().sphere_count <= left, "its bodies have more spheres than it holds");
    left -= bodies.back().sphere_count;
  });
  list.unless(bodies.empty() || left == 0, "it holds spheres of no body");
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
  const auto parsed = parse_json<json>(text, Refusal(name));
  const Value document(parsed, name);
  document.expect(parsed.is_object(), "is not an object");
  const auto format = document.find("format");
  document.expect(format && format->json() == kFormat,
                  "is not of format \"" + std::string(kFormat) + "\"");
  const Value version = document.at("version");
  version.expect(version.json().is_number_unsigned() && version.json() >= 1U,
                 "is not a positive integer");
  document.expect(version.json() <= kVersion, "has format version " + version.json().dump() +
                                                  "; this program reads versions up to " +
                                                  std::to_string(kVersion));

  SphereFile file;
  document.at("spheres").each(
      "sphere ", [&](const Value& sphere) { file.spheres.push_back(read_sphere(sphere)); });
  file.certificate = certificate_if_there(document, file.spheres.size());
  file.options = read_options(document);
  file.interrupted = read_interrupted(document);
  if (const auto bodies = document.find("bodies")) {
    file.bodies = read_bodies(*bodies, file.spheres.size());
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
