// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/format_text.h"
#include "collide/robot/internal/sphere_documents.h"
#include "spheretree/atomic_file.h"
#include "spheretree/error.h"

#include <algorithm>
#include <optional>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using YAML::Node;

std::string place_of(const Node& node) {
  return node.Mark().is_null() ? std::string() : "line " + std::to_string(node.Mark().line + 1);
}

// The one document of a file.
Node parsed(std::string_view text, const SphereGatherer& gathered) {
  try {
    const std::vector<Node> documents = YAML::LoadAll(std::string(text));
    gathered.unless(documents.size() == 1, {}, "does not hold exactly one YAML document");
    return documents.front();
  } catch (const YAML::Exception& error) {
    gathered.refuse("line " + std::to_string(error.mark.line + 1), "is not YAML: " + error.msg);
  }
}

std::string text_of(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsScalar(), place_of(node), what + " is not a text");
  return node.Scalar();
}

struct Member {
  std::string key;
  Node written_key;
  Node value;
};
using Members = std::vector<Member>;

// The members of a map in their order. Merge keys are refused: what they bring in would be missed.
Members members(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsMap(), place_of(node), what + " is not a map");
  Members found;
  std::set<std::string> keys;
  for (const auto& member : node) {
    const Node& key = member.first;
    gathered.unless(key.IsScalar(), place_of(key), what + " has a key that is not a text");
    gathered.unless(key.Scalar() != "<<" || key.Tag() == "!", place_of(key),
                    "merge keys (<<) are not read");
    gathered.unless(keys.insert(key.Scalar()).second, place_of(key),
                    what + " has the key \"" + key.Scalar() + "\" twice");
    found.push_back({key.Scalar(), key, member.second});
  }
  return found;
}

std::optional<Node> find(const Members& members, std::string_view key) {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const Member& member) { return member.key == key; });
  if (found == members.end() || found->value.IsNull()) return std::nullopt;
  return found->value;
}

Members members_if_there(const Members& parent, const std::string& key,
                         const SphereGatherer& gathered) {
  const auto node = find(parent, key);
  return node ? members(*node, key, gathered) : Members{};
}

// A quoted number is a text to every reader of YAML.
double number(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  std::optional<double> value;
  if (node.IsScalar() && node.Tag() != "!") value = number_of(node.Scalar());
  if (!value) gathered.refuse(place_of(node), what + " is not a number");
  return *value;
}

void read_ball(const Node& node, SphereGatherer& gathered) {
  const Members ball = members(node, "a sphere", gathered);
  const auto center = find(ball, "center");
  gathered.unless(center && center->IsSequence() && center->size() == 3, place_of(node),
                  "\"center\" is not [x, y, z]");
  Eigen::Vector3d point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[static_cast<Eigen::Index>(axis)] = number((*center)[axis], "a coordinate", gathered);
  }
  const auto radius = find(ball, "radius");
  if (!radius) gathered.refuse(place_of(node), "\"radius\" is missing");
  gathered.add(point, number(*radius, "\"radius\"", gathered), place_of(node));
}

void read_balls(const Node& node, SphereGatherer& gathered) {
  for (const auto& [link, key, balls] : members(node, "the spheres", gathered)) {
    gathered.begin_link(link, place_of(key));
    if (balls.IsNull()) continue;
    gathered.unless(balls.IsSequence(), place_of(balls), "spheres of a link are not a list");
    for (const auto& ball : balls) read_ball(ball, gathered);
  }
}

void read_ignored(const Members& ignored, SphereGatherer& gathered) {
  for (const auto& [link, key, others] : ignored) {
    if (others.IsNull()) continue;
    gathered.unless(others.IsSequence(), place_of(others), "ignored links are not a list");
    for (const auto& other : others) {
      gathered.ignore(link, text_of(other, "an ignored link", gathered));
    }
  }
}

std::map<std::string, double> read_buffers(const Members& buffers, SphereGatherer& gathered) {
  std::map<std::string, double> lengths;
  for (const auto& [link, key, length] : buffers) {
    lengths[link] = number(length, "a buffer", gathered);
  }
  return lengths;
}

// cuRobo looks at the balls of the links it is told to and no others.
void switch_off_unlisted(const Members& kinematics, SphereGatherer& gathered) {
  const auto listed = find(kinematics, "collision_link_names");
  if (!listed) return;
  gathered.unless(listed->IsSequence(), place_of(*listed),
                  "\"collision_link_names\" is not a list");
  std::set<std::string> names;
  for (const auto& name : *listed) names.insert(text_of(name, "a link's name", gathered));
  for (LinkSpheres& link : gathered.spheres.links) {
    if (names.contains(link.link)) continue;
    gathered.spheres.switched_off += link.spheres.size();
    link.spheres.clear();
  }
}

void read_curobo(const Members& root, const fs::path& path, SphereGatherer& gathered) {
  const Members configuration = members_if_there(root, "robot_cfg", gathered);
  Members kinematics =
      members_if_there(configuration.empty() ? root : configuration, "kinematics", gathered);
  if (kinematics.empty()) kinematics = root;
  const auto balls = find(kinematics, "collision_spheres");
  if (!balls) gathered.refuse({}, "has no \"collision_spheres\" and is no XRDF");
  if (balls->IsScalar()) {
    const fs::path side = path.parent_path() / balls->Scalar();
    SphereGatherer beside(side.string());
    const Members there = members(parsed(read_file(side), beside), "the file", beside);
    const auto found = find(there, "collision_spheres");
    if (!found) beside.refuse({}, "has no \"collision_spheres\"");
    read_balls(*found, beside);
    gathered.spheres = std::move(beside.spheres);
  } else {
    read_balls(*balls, gathered);
  }
  switch_off_unlisted(kinematics, gathered);
  const auto robot = find(root, "robot");
  if (robot && robot->IsScalar()) gathered.spheres.robot = robot->Scalar();
  read_ignored(members_if_there(kinematics, "self_collision_ignore", gathered), gathered);
  gathered.spheres.self_collision_buffer =
      read_buffers(members_if_there(kinematics, "self_collision_buffer", gathered), gathered);
  const auto buffer = find(kinematics, "collision_sphere_buffer");
  if (buffer && buffer->IsMap()) {
    gathered.spheres.collision_buffers =
        read_buffers(members(*buffer, "collision_sphere_buffer", gathered), gathered);
  } else if (buffer) {
    gathered.spheres.collision_buffer = number(*buffer, "\"collision_sphere_buffer\"", gathered);
  }
}

// The geometry that collision checks use.
std::string xrdf_geometry(const Members& root, const SphereGatherer& gathered) {
  const Members collision = members_if_there(root, "collision", gathered);
  const auto name = find(collision, "geometry");
  if (!name) gathered.refuse({}, "names no geometry for collision");
  return text_of(*name, "the name of a geometry", gathered);
}

void read_xrdf(const Members& root, SphereGatherer& gathered) {
  const auto version = find(root, "format_version");
  if (!version) gathered.refuse({}, "\"format_version\" is missing");
  const double number_of_version = number(*version, "\"format_version\"", gathered);
  gathered.unless(number_of_version >= 1.0 && number_of_version < 2.0, place_of(*version),
                  "is of a version of XRDF other than 1");
  const std::string name = xrdf_geometry(root, gathered);
  const Members geometries = members_if_there(root, "geometry", gathered);
  const auto geometry = find(geometries, name);
  if (!geometry) gathered.refuse({}, "has no geometry \"" + name + "\"");
  const auto balls = find(members(*geometry, "the geometry", gathered), "spheres");
  if (!balls) gathered.refuse(place_of(*geometry), "the geometry has no spheres");
  read_balls(*balls, gathered);
  const Members collision = members_if_there(root, "collision", gathered);
  gathered.spheres.collision_buffers =
      read_buffers(members_if_there(collision, "buffer_distance", gathered), gathered);
  const Members self = members_if_there(root, "self_collision", gathered);
  gathered.spheres.self_collision_buffer =
      read_buffers(members_if_there(self, "buffer_distance", gathered), gathered);
  read_ignored(members_if_there(self, "ignore", gathered), gathered);
}

// Writes a document anew, with other balls at one place.
class Rewriter {
 public:
  Rewriter(const RobotSpheres& spheres, const SphereGatherer& gathered,
           std::vector<std::string> place)
      : spheres_(spheres), gathered_(gathered), place_(std::move(place)) {}

  std::string write(const Node& root) {
    put_map(root, 0, 0);
    return std::move(text_);
  }

 private:
  static constexpr int kDeepest = 64;  // an anchor may hold itself
  static constexpr std::size_t kLongest = 1u
                                          << 28;  // or twice another that does the same, and so on

  // `found` is how far the keys down to here are those of the place; beyond it, more than all.
  void put_map(const Node& node, int indent, std::size_t found) {
    const bool on_the_way = found < place_.size();
    bool seen = false;
    for (const auto& [key, written_key, value] : members(node, "a part", gathered_)) {
      text_ += std::string(static_cast<std::size_t>(indent), ' ') + scalar(written_key) + ":";
      const bool next = on_the_way && key == place_[found];
      seen = seen || next;
      if (next && found + 1 == place_.size()) {
        put_spheres(indent);
      } else if (on_the_way && key == "collision_link_names" && found + 1 == place_.size()) {
        put_names(value, indent);
      } else {
        put_value(value, indent, next ? found + 1 : place_.size());
      }
    }
    gathered_.unless(seen || !on_the_way, place_of(node), "has no place for spheres");
  }

  void put_spheres(int indent) { text_.append("\n").append(yaml_spheres(spheres_, indent + 2)); }

  // Links with balls are to be looked at.
  void put_names(const Node& names, int indent) {
    Node all = YAML::Clone(names);
    for (const LinkSpheres& link : spheres_.links) {
      const bool listed = std::any_of(names.begin(), names.end(), [&](const Node& name) {
        return name.IsScalar() && name.Scalar() == link.link;
      });
      if (!listed && !link.spheres.empty()) all.push_back(link.link);
    }
    put_value(all, indent, place_.size());
  }

  void put_value(const Node& node, int indent, std::size_t found) {
    gathered_.unless(indent <= 2 * kDeepest && text_.size() < kLongest, place_of(node),
                     "is too deep or too long");
    if (node.IsMap() && node.size() > 0) {
      text_ += "\n";
      put_map(node, indent + 2, found);
    } else if (node.IsSequence() && node.size() > 0) {
      text_ += "\n";
      for (const auto& item : node) {
        text_ += std::string(static_cast<std::size_t>(indent), ' ') + "-";
        put_value(item, indent + 2, place_.size());
      }
    } else {
      text_.append(" ").append(scalar(node)).append("\n");
    }
  }

  static std::string scalar(const Node& node) {
    if (node.IsMap()) return "{}";
    if (node.IsSequence()) return "[]";
    if (node.IsNull()) return "null";
    const std::string& tag = node.Tag();
    // Plain texts, numbers and truth values stay as they are; those over several lines cannot.
    if (tag == "?" && node.Scalar().find('\n') == std::string::npos) return node.Scalar();
    const bool has_type = !tag.empty() && tag != "?" && tag != "!";
    const std::string type = has_type ? std::string("!<").append(tag).append("> ") : "";
    return type + yaml_text(node.Scalar());
  }

  const RobotSpheres& spheres_;
  const SphereGatherer& gathered_;
  const std::vector<std::string> place_;
  std::string text_;
};

}  // namespace

SphereFormatFile read_sphere_yaml(std::string_view text, const fs::path& path) {
  SphereGatherer gathered(path.string());
  const Members root = members(parsed(text, gathered), "the file", gathered);
  const auto format = find(root, "format");
  const bool xrdf = format && format->IsScalar() && format->Scalar() == "xrdf";
  if (xrdf) {
    read_xrdf(root, gathered);
  } else {
    read_curobo(root, path, gathered);
  }
  return {xrdf ? SphereFormat::kXrdf : SphereFormat::kCurobo, std::move(gathered.spheres)};
}

std::string with_spheres(std::string_view text, const fs::path& path, const RobotSpheres& spheres,
                         SphereFormat format) {
  const SphereGatherer gathered(path.string());
  const Node document = parsed(text, gathered);
  const Members root = members(document, "the file", gathered);
  std::vector<std::string> place;
  if (format == SphereFormat::kXrdf) {
    place = {"geometry", xrdf_geometry(root, gathered), "spheres"};
  } else {
    if (find(root, "robot_cfg")) place.push_back("robot_cfg");
    const Members inner = members_if_there(root, "robot_cfg", gathered);
    if (find(inner.empty() ? root : inner, "kinematics")) place.push_back("kinematics");
    place.push_back("collision_spheres");
  }
  return Rewriter(spheres, gathered, std::move(place)).write(document);
}

}  // namespace spherule::internal
