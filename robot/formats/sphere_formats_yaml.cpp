// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "robot/formats/sphere_documents.h"
#include "robot/formats/yaml_nodes.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <yaml-cpp/eventhandler.h>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using YAML::Node;

// Counts documents. yaml-cpp 0.7 finds empty ones without end behind some tokens that are out of
// place, such as "}" at the beginning, and LoadAll() would collect them.
class DocumentCounter : public YAML::EventHandler {
 public:
  int documents() const { return documents_; }

  void OnDocumentStart(const YAML::Mark&) override { ++documents_; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

 private:
  int documents_ = 0;
};

std::string line_and_column(const YAML::Mark& mark) {
  if (mark.is_null()) return {};
  const std::string line = "line " + std::to_string(mark.line + 1);
  // Column 0 is also what yaml-cpp says where it knows none, at the end of a text.
  return mark.column == 0 ? line : line + ", column " + std::to_string(mark.column + 1);
}

// Whether the line at a place is indented by a tab, which yaml-cpp does not say.
bool is_indented_by_tab(const YAML::Mark& mark, std::string_view text) {
  for (int line = 0; line < mark.line; ++line) {
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    if (text.empty()) return false;
  }
  return text.substr(0, text.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
}

// What yaml-cpp says of the faults that are common, for those who write files by hand.
std::string plain_words(const YAML::Exception& error, std::string_view text) {
  const std::array<std::pair<std::string_view, const char*>, 11> words{{
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a '[' before is not closed"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "a '{' before is not closed"},
      {YAML::ErrorMsg::END_OF_SEQ, "the indentation does not fit the lines before"},
      {YAML::ErrorMsg::END_OF_MAP, "the indentation does not fit the lines before"},
      {YAML::ErrorMsg::MAP_VALUE, "a ':' where no key can stand"},
      {YAML::ErrorMsg::MAP_KEY, "a '?' where no key can stand"},
      {YAML::ErrorMsg::BLOCK_ENTRY, "a '-' where no entry of a list can stand"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "no value begins so; put a text in quotes"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "a text in quotes is not ended"},
      {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias (*) names no anchor (&) before it"},
      {YAML::ErrorMsg::FLOW_END, "a ']' or '}' that closes nothing"},
  }};
  const auto known =
      std::ranges::find_if(words, [&](const auto& word) { return word.first == error.msg; });
  const std::string reason = known != words.end() ? known->second : error.msg;
  return is_indented_by_tab(error.mark, text)
             ? reason + "; the line is indented by a tab, where YAML takes blanks"
             : reason;
}

// The document of a text that holds exactly one, otherwise nothing. Throws YAML::Exception.
std::optional<Node> only_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentCounter counter;
  while (counter.documents() < 2 && parser.HandleNextDocument(counter)) {
  }
  if (counter.documents() != 1) return std::nullopt;
  return YAML::Load(text);
}

// A quoted number is a text to every reader of YAML.
double number(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  std::optional<double> value;
  if (node.IsScalar() && node.Tag() != "!") value = finite_number(node.Scalar());
  if (!value) gathered.refuse(place_of(node), what + " is not a number");
  return *value;
}

void read_sphere(const Node& node, SphereGatherer& gathered) {
  const YamlMembers sphere = yaml_members(node, "a sphere", gathered);
  const auto center = find_member(sphere, "center");
  gathered.unless(center && center->IsSequence() && center->size() == 3, place_of(node),
                  "\"center\" is not [x, y, z]");
  Eigen::Vector3d point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    point[static_cast<Eigen::Index>(axis)] = number((*center)[axis], "a coordinate", gathered);
  }
  const auto radius = find_member(sphere, "radius");
  if (!radius) gathered.refuse(place_of(node), "\"radius\" is missing");
  gathered.add(point, number(*radius, "\"radius\"", gathered), place_of(node));
}

void read_spheres(const Node& node, SphereGatherer& gathered) {
  for (const auto& [link, key, spheres] : yaml_members(node, "the spheres", gathered)) {
    gathered.begin_link(link, place_of(key));
    if (spheres.IsNull()) continue;
    gathered.unless(spheres.IsSequence(), place_of(spheres), "spheres of a link are not a list");
    for (const auto& sphere : spheres) read_sphere(sphere, gathered);
  }
}

void read_ignored(const YamlMembers& ignored, SphereGatherer& gathered) {
  for (const auto& [link, key, others] : ignored) {
    if (others.IsNull()) continue;
    gathered.unless(others.IsSequence(), place_of(others), "ignored links are not a list");
    gathered.take(others.size(), place_of(others));
    for (const auto& other : others) {
      gathered.ignore(link, yaml_scalar(other, "an ignored link", gathered), place_of(other));
    }
  }
}

std::map<std::string, double> read_buffers(const YamlMembers& buffers, SphereGatherer& gathered) {
  std::map<std::string, double> lengths;
  for (const auto& [link, key, length] : buffers) {
    gathered.take_name(link, place_of(length));
    lengths[link] = number(length, "a buffer", gathered);
  }
  return lengths;
}

// cuRobo examines the spheres of the links it is told to and no others.
void switch_off_unlisted(const YamlMembers& kinematics, SphereGatherer& gathered) {
  const auto listed = find_member(kinematics, "collision_link_names");
  if (!listed) return;
  gathered.unless(listed->IsSequence(), place_of(*listed),
                  "\"collision_link_names\" is not a list");
  std::set<std::string> names;
  gathered.take(listed->size(), place_of(*listed));
  for (const auto& name : *listed) {
    const std::string link = yaml_scalar(name, "a link's name", gathered);
    gathered.take_name(link, place_of(name));
    names.insert(link);
  }
  for (LinkSpheres& link : gathered.spheres.links) {
    if (names.contains(link.link)) continue;
    for (const Sphere& sphere : link.spheres) gathered.leave_out(link.link, sphere);
    link.spheres.clear();
  }
}

void read_curobo(const YamlMembers& root, const fs::path& path, SphereGatherer& gathered) {
  const YamlMembers configuration = members_if_there(root, "robot_cfg", gathered);
  YamlMembers kinematics =
      members_if_there(configuration.empty() ? root : configuration, "kinematics", gathered);
  if (kinematics.empty()) kinematics = root;
  const auto spheres = find_member(kinematics, "collision_spheres");
  if (!spheres) gathered.refuse({}, "has no \"collision_spheres\" and is no XRDF");
  if (spheres->IsScalar()) {
    const fs::path side = path.parent_path() / spheres->Scalar();
    const std::string text = [&] {
      try {
        require_regular_file(side);
        return read_file(side);
      } catch (const Error& error) {
        gathered.refuse("\"collision_spheres\"", error.what());
      }
    }();
    SphereGatherer beside(side.string(), text.size());
    const YamlMembers there = yaml_members(yaml_document(text, beside), "the file", beside);
    const auto found = find_member(there, "collision_spheres");
    if (!found) beside.refuse({}, "has no \"collision_spheres\"");
    read_spheres(*found, beside);
    gathered.spheres = std::move(beside.spheres);
    gathered.left_out = std::move(beside.left_out);
  } else {
    read_spheres(*spheres, gathered);
  }
  switch_off_unlisted(kinematics, gathered);
  const auto robot = find_member(root, "robot");
  if (robot && robot->IsScalar()) gathered.spheres.robot = robot->Scalar();
  read_ignored(members_if_there(kinematics, "self_collision_ignore", gathered), gathered);
  gathered.spheres.self_collision_buffer =
      read_buffers(members_if_there(kinematics, "self_collision_buffer", gathered), gathered);
  const auto buffer = find_member(kinematics, "collision_sphere_buffer");
  if (buffer && buffer->IsMap()) {
    gathered.spheres.collision_buffers =
        read_buffers(yaml_members(*buffer, "collision_sphere_buffer", gathered), gathered);
  } else if (buffer) {
    gathered.spheres.collision_buffer = number(*buffer, "\"collision_sphere_buffer\"", gathered);
  }
}

void read_xrdf(const YamlMembers& root, SphereGatherer& gathered) {
  const auto version = find_member(root, "format_version");
  if (!version) gathered.refuse({}, "\"format_version\" is missing");
  const double number_of_version = number(*version, "\"format_version\"", gathered);
  gathered.unless(number_of_version >= 1.0 && number_of_version < 2.0, place_of(*version),
                  "is of a version of XRDF other than 1");
  const std::string name = xrdf_geometry(root, gathered);
  const YamlMembers geometries = members_if_there(root, "geometry", gathered);
  const auto geometry = find_member(geometries, name);
  if (!geometry) gathered.refuse({}, "has no geometry \"" + name + "\"");
  const auto spheres = find_member(yaml_members(*geometry, "the geometry", gathered), "spheres");
  if (!spheres) gathered.refuse(place_of(*geometry), "the geometry has no spheres");
  read_spheres(*spheres, gathered);
  const YamlMembers collision = members_if_there(root, "collision", gathered);
  gathered.spheres.collision_buffers =
      read_buffers(members_if_there(collision, "buffer_distance", gathered), gathered);
  const YamlMembers self = members_if_there(root, "self_collision", gathered);
  gathered.spheres.self_collision_buffer =
      read_buffers(members_if_there(self, "buffer_distance", gathered), gathered);
  read_ignored(members_if_there(self, "ignore", gathered), gathered);
  const auto own = find_member(self, "geometry");
  if (!own) return;
  const std::string own_name = yaml_scalar(*own, "the name of a geometry", gathered);
  gathered.unless(find_member(geometries, own_name).has_value(), place_of(*own),
                  "has no geometry \"" + own_name + "\"");
  if (own_name != name) gathered.spheres.self_collision_geometry = own_name;
}

}  // namespace

std::string place_of(const Node& node) {
  return node.Mark().is_null() ? std::string() : "line " + std::to_string(node.Mark().line + 1);
}

Node yaml_document(std::string_view text, const SphereGatherer& gathered) {
  // yaml-cpp copies the whole tag to each node that has its handle.
  const bool has_handles =
      text.starts_with("%TAG") || text.find("\n%TAG") != std::string_view::npos;
  gathered.unless(!has_handles, {}, "%TAG directives are not read");
  try {
    const std::optional<Node> document = only_document(std::string(text));
    gathered.unless(document.has_value(), {}, "does not hold exactly one YAML document");
    return *document;
  } catch (const YAML::Exception& error) {
    gathered.refuse(line_and_column(error.mark), "is not YAML: " + plain_words(error, text));
  }
}

std::string yaml_scalar(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsScalar(), place_of(node), what + " is not a text");
  return node.Scalar();
}

YamlMembers yaml_members(const Node& node, const std::string& what,
                         const SphereGatherer& gathered) {
  gathered.unless(node.IsMap(), place_of(node), what + " is not a map");
  gathered.take(node.size(), place_of(node));
  YamlMembers found;
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

std::optional<Node> find_member(const YamlMembers& members, std::string_view key) {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const YamlMember& member) { return member.key == key; });
  if (found == members.end() || found->value.IsNull()) return std::nullopt;
  return found->value;
}

YamlMembers members_if_there(const YamlMembers& parent, const std::string& key,
                             const SphereGatherer& gathered) {
  const auto node = find_member(parent, key);
  return node ? yaml_members(*node, key, gathered) : YamlMembers{};
}

std::string xrdf_geometry(const YamlMembers& root, const SphereGatherer& gathered) {
  const YamlMembers collision = members_if_there(root, "collision", gathered);
  const auto name = find_member(collision, "geometry");
  if (!name) gathered.refuse({}, "names no geometry for collision");
  return yaml_scalar(*name, "the name of a geometry", gathered);
}

SphereFormat gather_spheres(const YamlMembers& root, const fs::path& path,
                            SphereGatherer& gathered) {
  const auto format = find_member(root, "format");
  const bool xrdf = format && format->IsScalar() && format->Scalar() == "xrdf";
  if (xrdf) {
    read_xrdf(root, gathered);
  } else {
    read_curobo(root, path, gathered);
  }
  return xrdf ? SphereFormat::kXrdf : SphereFormat::kCurobo;
}

SphereFormatFile read_sphere_yaml(std::string_view text, const fs::path& path) {
  SphereGatherer gathered(path.string(), text.size());
  const YamlMembers root = yaml_members(yaml_document(text, gathered), "the file", gathered);
  const SphereFormat format = gather_spheres(root, path, gathered);
  return {format, std::move(gathered.spheres)};
}

}  // namespace spherule::internal
