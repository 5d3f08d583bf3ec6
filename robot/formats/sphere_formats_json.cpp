// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/json.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "spherule-robot-spheres";
constexpr std::uint64_t kVersion = 1;
constexpr const char* kOneMeshFormat = "spherule-spheres";

using Value = JsonValue<Json>;

std::string place_of(const std::string& link) {
  return "link \"" + link + "\"";
}

Eigen::Vector3d point(const Value& value) {
  return Eigen::Vector3d(value.numbers<3>("[x, y, z]").data());
}

// Reads spheres, and says of those that are something else where they are.
class Reader {
 public:
  explicit Reader(std::string file) : gathered(std::move(file)) {}

  // A list of {"CENTER":[x,y,z],"radius":r}.
  void spheres(const Value& list, const char* center, const std::string& link) {
    list.placed(link).each(link + ", sphere ", [&](const Value& sphere) {
      gathered.add(point(sphere.at(center)), sphere.at("radius").number(), sphere.place());
    });
  }

  // {"centers":[[x,y,z],...],"radii":[r,...]}.
  void columns(const Value& value) {
    const Value radii = value.at("radii");
    radii.expect(radii.json().is_array(), "is not a list");
    value.unless(value.at("centers").json().size() == radii.json().size(),
                 "has other counts of centers and radii");
    std::size_t index = 0;
    value.at("centers").each(value.place() + ", sphere ", [&](const Value& center) {
      gathered.add(point(center), radii.part(radii.json()[index++]).number(), center.place());
    });
  }

  // One level of a foam list, the finest unless another is requested.
  void foam(const Value& levels, const SphereReadOptions& options) {
    const std::size_t count = levels.json().size();
    levels.expect(levels.json().is_array(), "is not a list");
    levels.expect(count > options.level.value_or(0),
                  "has only " + std::to_string(count) + " levels");
    const Json& level = levels.json()[options.level.value_or(count - 1)];
    spheres(levels.part(level).at("spheres"), "origin", levels.place());
  }

  // {"BiggesetSphere":[x,y,z,r],"SubSpheres":{"r0":[x,y,z,r],...}}: two levels.
  void irmv(const Value& value, const SphereReadOptions& options) {
    const auto add = [&](const Value& sphere) {
      const auto [x, y, z, radius] = sphere.numbers<4>("[x, y, z, r]");
      gathered.add({x, y, z}, radius, value.place());
    };
    value.unless(options.level.value_or(0) < 2, "has only 2 levels");
    if (options.level == 0) return add(value.at("BiggesetSphere"));
    const Value parts = value.at("SubSpheres");
    parts.expect(parts.json().is_object(), "is not an object");
    for (const Json& sphere : parts.json()) add(parts.part(sphere));
  }

  SphereGatherer gathered;
};

std::map<std::string, double> read_buffers(const Value& document, const char* key) {
  std::map<std::string, double> lengths;
  const std::optional<Value> found = document.find(key);
  if (!found) return lengths;
  found->expect(found->json().is_object(), "is not an object");
  for (const auto& [link, length] : found->json().items()) {
    lengths[link] = found->part(length).number();
  }
  return lengths;
}

void read_own(const Value& document, Reader& reader) {
  const Value version = document.at("version");
  version.expect(version.json().is_number_unsigned() && version.json() >= 1U,
                 "is not a positive integer");
  document.unless(version.json() <= kVersion, "has format version " + version.json().dump() +
                                                  "; this program reads versions up to " +
                                                  std::to_string(kVersion));
  RobotSpheres& spheres = reader.gathered.spheres;
  spheres.robot = document.at("robot").text();
  document.at("links").each("link ", [&](const Value& link) {
    const std::string name = link.at("link").text();
    const std::string place = place_of(name);
    reader.gathered.begin_link(name, place);
    link.placed(place).at("spheres").each(place + ", sphere ", [&](const Value& sphere) {
      const Sphere read{point(sphere.at("center")), sphere.at("radius").number()};
      sphere.expect(is_usable(read), "is negative or beyond 1e15");
      spheres.links.back().spheres.push_back(read);
    });
  });
  if (const auto pairs = document.find("self_collision_ignore")) {
    pairs->each(pairs->place() + " ", [&](const Value& pair) {
      const auto reason = pair.find("reason");
      spheres.self_collision_ignore.push_back({pair.at("link1").text(), pair.at("link2").text(),
                                               reason ? reason->text() : std::string()});
    });
  }
  spheres.self_collision_buffer = read_buffers(document, "self_collision_buffer");
  spheres.collision_buffers = read_buffers(document, "collision_buffers");
  if (const auto buffer = document.find("collision_buffer")) {
    spheres.collision_buffer = buffer->number();
  }
  if (const auto interrupted = document.find("interrupted")) {
    spheres.interrupted = interrupted->truth();
  }
}

// Of an object without a format of its own: by what it holds.
SphereFormat format_of(const Value& value) {
  const Json& document = value.json();
  value.unless(document.is_object() && !document.empty(), "is JSON of no known format of spheres");
  const auto centers = document.find("centers");
  if (centers != document.end() && centers->is_array() &&
      (centers->empty() || centers->front().is_array())) {
    return SphereFormat::kMorphit;
  }
  const Json& first = *document.begin();
  if (first.is_array()) return SphereFormat::kFoam;
  if (first.is_object() && first.contains("centers")) return SphereFormat::kBallpark;
  if (first.is_object() && first.contains("BiggesetSphere")) return SphereFormat::kIrmv;
  value.refuse("is JSON of no known format of spheres");
}

std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::strict);
}

std::string number_list(const Eigen::Vector3d& point) {
  return text_of(Json{point.x(), point.y(), point.z()});
}

// One sphere a line.
std::string sphere_list(const std::vector<Sphere>& spheres, const char* center) {
  std::string text = "[";
  for (const Sphere& sphere : spheres) {
    text += text.size() == 1 ? "\n" : ",\n";
    text += std::string("{\"") + center + "\":" + number_list(sphere.center) +
            ",\"radius\":" + text_of(sphere.radius) + "}";
  }
  return text + "]";
}

}  // namespace

SphereFormatFile read_sphere_json(std::string_view text, const std::filesystem::path& path,
                                  const SphereReadOptions& options) {
  Reader reader(path.string());
  const std::string& file = reader.gathered.file();
  const auto document = parse_json<Json>(
      text, [&](const std::string& reason) { reader.gathered.refuse({}, reason); });
  const Value root(document, file);
  const auto one_mesh = [&] { reader.gathered.begin_link(options.link, ""); };
  SphereFormat format = SphereFormat::kFoam;
  if (document.is_array()) {
    one_mesh();
    reader.foam(root.placed("the list"), options);
  } else if (const auto named = document.find("format");
             named != document.end() && named->is_string()) {
    if (*named == kOneMeshFormat) {
      format = SphereFormat::kSphereFile;
      one_mesh();
      reader.gathered.spheres.links.back().spheres = load_spheres_in_metres(path);
    } else {
      format = SphereFormat::kSpherule;
      root.unless(*named != "spherule-scene",
                  "is a scene, not spheres (spherule check --view shows it)");
      root.unless(*named == kFormat, "has the unknown format " + text_of(*named));
      read_own(root, reader);
    }
  } else if (format = format_of(root); format == SphereFormat::kMorphit) {
    one_mesh();
    reader.columns(root.placed("the file"));
  } else {
    for (const auto& [link, value] : document.items()) {
      const Value of_link(value, file, place_of(link));
      reader.gathered.begin_link(link, of_link.place());
      if (format == SphereFormat::kFoam) reader.foam(of_link, options);
      if (format == SphereFormat::kBallpark) reader.columns(of_link);
      if (format == SphereFormat::kIrmv) reader.irmv(of_link, options);
    }
  }
  return {format, std::move(reader.gathered.spheres)};
}

// foam's own measures of error are left open: they are not what is proved here.
std::string sphere_foam(const RobotSpheres& spheres) {
  std::string text = "{";
  for (const LinkSpheres& link : spheres.links) {
    text += (text.size() == 1 ? "\n" : ",\n") + text_of(link.link) +
            ":[{\"mean\":null,\"best\":null,\"worst\":null,\"spheres\":" +
            sphere_list(link.spheres, "origin") + "}]";
  }
  return text + "\n}\n";
}

std::string sphere_json(const RobotSpheres& spheres) {
  std::string text = std::string("{\"format\":\"") + kFormat +
                     "\",\"version\":" + std::to_string(kVersion) +
                     ",\"robot\":" + text_of(spheres.robot) + ",\n\"links\":[";
  bool first = true;
  for (const LinkSpheres& link : spheres.links) {
    text += std::string(first ? "\n" : ",\n") + "{\"link\":" + text_of(link.link) +
            ",\"spheres\":" + sphere_list(link.spheres, "center") + "}";
    first = false;
  }
  Json pairs = Json::array();
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    Json written = {{"link1", pair.link_a}, {"link2", pair.link_b}};
    if (!pair.reason.empty()) written["reason"] = pair.reason;
    pairs.push_back(std::move(written));
  }
  return text + "\n],\n\"self_collision_ignore\":" + text_of(pairs) +
         ",\n\"self_collision_buffer\":" + text_of(Json(spheres.self_collision_buffer)) +
         ",\n\"collision_buffer\":" + text_of(spheres.collision_buffer) +
         ",\n\"collision_buffers\":" + text_of(Json(spheres.collision_buffers)) +
         (spheres.interrupted ? ",\n\"interrupted\":true}\n" : "}\n");
}

}  // namespace spherule::internal
