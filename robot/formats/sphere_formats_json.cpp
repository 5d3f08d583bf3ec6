// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/json.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <vector>

namespace spherule::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "spherule-robot-spheres";
constexpr std::uint64_t kVersion = 1;
constexpr const char* kOneMeshFormat = "spherule-spheres";

Json parsed(std::string_view text, const SphereGatherer& gathered) {
  return parse_json<Json>(text, [&](const std::string& reason) { gathered.refuse({}, reason); });
}

// Reads values, and says of those that are of another type where they are.
class Reader {
 public:
  explicit Reader(std::string file) : gathered(std::move(file)) {}

  const Json& member(const Json& object, const char* key, const std::string& place) const {
    gathered.unless(object.is_object(), place, "is not an object");
    const auto found = object.find(key);
    if (found == object.end()) gathered.refuse(place, std::string("\"") + key + "\" is missing");
    return *found;
  }

  const Json& list(const Json& value, const std::string& place) const {
    gathered.unless(value.is_array(), place, "is not a list");
    return value;
  }

  double number(const Json& value, const std::string& place) const {
    gathered.unless(value.is_number(), place, "is not a number");
    return value.get<double>();
  }

  std::string text(const Json& value, const std::string& place) const {
    gathered.unless(value.is_string(), place, "is not a text");
    return value.get<std::string>();
  }

  Eigen::Vector3d point(const Json& value, const std::string& place) const {
    gathered.unless(value.is_array() && value.size() == 3, place, "is not [x, y, z]");
    Eigen::Vector3d read;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      read[static_cast<Eigen::Index>(axis)] = number(value[axis], place);
    }
    return read;
  }

  // A list of {"CENTER":[x,y,z],"radius":r}.
  void spheres(const Json& value, const char* center, const std::string& link) {
    std::size_t index = 0;
    for (const Json& sphere : list(value, link)) {
      const std::string place = sphere_place(link, index++);
      const Eigen::Vector3d at = point(member(sphere, center, place), place);
      gathered.add(at, number(member(sphere, "radius", place), place), place);
    }
  }

  // {"centers":[[x,y,z],...],"radii":[r,...]}.
  void columns(const Json& value, const std::string& link) {
    const Json& centers = list(member(value, "centers", link), link);
    const Json& radii = list(member(value, "radii", link), link);
    gathered.unless(centers.size() == radii.size(), link, "has other counts of centers and radii");
    for (std::size_t i = 0; i < centers.size(); ++i) {
      const std::string place = sphere_place(link, i);
      gathered.add(point(centers[i], place), number(radii[i], place), place);
    }
  }

  // One level of a foam list, the finest unless another is requested.
  void foam(const Json& levels, const SphereReadOptions& options, const std::string& link) {
    gathered.unless(list(levels, link).size() > options.level.value_or(0), link,
                    "has only " + std::to_string(levels.size()) + " levels");
    const Json& level = levels[options.level.value_or(levels.size() - 1)];
    spheres(member(level, "spheres", link), "origin", link);
  }

  // {"BiggesetSphere":[x,y,z,r],"SubSpheres":{"r0":[x,y,z,r],...}}: two levels.
  void irmv(const Json& value, const SphereReadOptions& options, const std::string& link) {
    const auto add = [&](const Json& sphere) {
      gathered.unless(sphere.is_array() && sphere.size() == 4, link, "is not [x, y, z, r]");
      const Json center = {sphere[0], sphere[1], sphere[2]};
      gathered.add(point(center, link), number(sphere[3], link), link);
    };
    gathered.unless(options.level.value_or(0) < 2, link, "has only 2 levels");
    if (options.level == 0) return add(member(value, "BiggesetSphere", link));
    const Json& parts = member(value, "SubSpheres", link);
    gathered.unless(parts.is_object(), link, "\"SubSpheres\" is not an object");
    for (const Json& sphere : parts) add(sphere);
  }

  static std::string sphere_place(const std::string& link, std::size_t index) {
    return link + ", sphere " + std::to_string(index);
  }

  SphereGatherer gathered;
};

std::string place_of(const std::string& link) {
  return "link \"" + link + "\"";
}

std::map<std::string, double> read_buffers(const Json& document, const char* key,
                                           const Reader& reader) {
  std::map<std::string, double> lengths;
  const auto found = document.find(key);
  if (found == document.end()) return lengths;
  reader.gathered.unless(found->is_object(), key, "is not an object");
  for (const auto& [link, length] : found->items()) lengths[link] = reader.number(length, key);
  return lengths;
}

void read_own(const Json& document, Reader& reader) {
  const Json& version = reader.member(document, "version", "");
  reader.gathered.unless(version.is_number_unsigned() && version.get<std::uint64_t>() >= 1, {},
                         "\"version\" is not a positive integer");
  reader.gathered.unless(version.get<std::uint64_t>() <= kVersion, {},
                         "has format version " + version.dump() +
                             "; this program reads versions up to " + std::to_string(kVersion));
  RobotSpheres& spheres = reader.gathered.spheres;
  spheres.robot = reader.text(reader.member(document, "robot", ""), "\"robot\"");
  for (const Json& link : reader.list(reader.member(document, "links", ""), "\"links\"")) {
    const std::string name = reader.text(reader.member(link, "link", "a link"), "a link's name");
    const std::string place = place_of(name);
    reader.gathered.begin_link(name, place);
    std::size_t index = 0;
    for (const Json& sphere : reader.list(reader.member(link, "spheres", place), place)) {
      const std::string here = Reader::sphere_place(place, index++);
      const Sphere read{reader.point(reader.member(sphere, "center", here), here),
                        reader.number(reader.member(sphere, "radius", here), here)};
      reader.gathered.unless(is_usable(read), here, "is negative or beyond 1e15");
      spheres.links.back().spheres.push_back(read);
    }
  }
  if (const auto pairs = document.find("self_collision_ignore"); pairs != document.end()) {
    const std::string place = "\"self_collision_ignore\"";
    for (const Json& pair : reader.list(*pairs, place)) {
      const auto reason = pair.is_object() ? pair.find("reason") : pair.end();
      spheres.self_collision_ignore.push_back(
          {reader.text(reader.member(pair, "link1", place), place),
           reader.text(reader.member(pair, "link2", place), place),
           reason == pair.end() ? std::string() : reader.text(*reason, place)});
    }
  }
  spheres.self_collision_buffer = read_buffers(document, "self_collision_buffer", reader);
  spheres.collision_buffers = read_buffers(document, "collision_buffers", reader);
  if (const auto buffer = document.find("collision_buffer"); buffer != document.end()) {
    spheres.collision_buffer = reader.number(*buffer, "\"collision_buffer\"");
  }
  if (const auto interrupted = document.find("interrupted"); interrupted != document.end()) {
    reader.gathered.unless(interrupted->is_boolean(), "\"interrupted\"", "is not true or false");
    spheres.interrupted = interrupted->get<bool>();
  }
}

// Of an object without a format of its own: by what it holds.
SphereFormat format_of(const Json& document, const Reader& reader) {
  reader.gathered.unless(document.is_object() && !document.empty(), {},
                         "is JSON of no known format of spheres");
  const auto centers = document.find("centers");
  if (centers != document.end() && centers->is_array() &&
      (centers->empty() || centers->front().is_array())) {
    return SphereFormat::kMorphit;
  }
  const Json& first = *document.begin();
  if (first.is_array()) return SphereFormat::kFoam;
  if (first.is_object() && first.contains("centers")) return SphereFormat::kBallpark;
  if (first.is_object() && first.contains("BiggesetSphere")) return SphereFormat::kIrmv;
  reader.gathered.refuse({}, "is JSON of no known format of spheres");
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
  const Json document = parsed(text, reader.gathered);
  const auto one_mesh = [&] { reader.gathered.begin_link(options.link, ""); };
  SphereFormat format = SphereFormat::kFoam;
  if (document.is_array()) {
    one_mesh();
    reader.foam(document, options, "the list");
  } else if (const auto named = document.find("format");
             named != document.end() && named->is_string()) {
    if (*named == kOneMeshFormat) {
      format = SphereFormat::kSphereFile;
      one_mesh();
      reader.gathered.spheres.links.back().spheres = load_spheres_in_metres(path);
    } else {
      format = SphereFormat::kSpherule;
      reader.gathered.unless(*named != "spherule-scene", {},
                             "is a scene, not spheres (spherule check --view shows it)");
      reader.gathered.unless(*named == kFormat, {}, "has the unknown format " + text_of(*named));
      read_own(document, reader);
    }
  } else if (format = format_of(document, reader); format == SphereFormat::kMorphit) {
    one_mesh();
    reader.columns(document, "the file");
  } else {
    for (const auto& [link, value] : document.items()) {
      const std::string place = place_of(link);
      reader.gathered.begin_link(link, place);
      if (format == SphereFormat::kFoam) reader.foam(value, options, place);
      if (format == SphereFormat::kBallpark) reader.columns(value, place);
      if (format == SphereFormat::kIrmv) reader.irmv(value, options, place);
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
