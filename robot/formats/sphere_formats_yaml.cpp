// SPDX-License-Identifier: BSD-3-Clause
// cuRobo and XRDF: files that are read, new ones, and existing ones with other spheres.
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using YAML::Node;
using Keys = std::vector<std::string>;

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

// "line 7", or nothing where that is not known.
std::string place_of(const Node& node) {
  return node.Mark().is_null() ? std::string() : "line " + std::to_string(node.Mark().line + 1);
}

// The one document of a file.
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

// A text, a number or a truth value; `what` is the subject of the complaint about other nodes.
std::string yaml_scalar(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  gathered.unless(node.IsScalar(), place_of(node), what + " is not a text");
  return node.Scalar();
}

struct YamlMember {
  std::string key;
  Node written_key;
  Node value;
};
using YamlMembers = std::vector<YamlMember>;

// The members of a map in their order. Merge keys are refused: what they bring in would be missed.
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

// The value of a key, if there is one that is not null.
std::optional<Node> find_member(const YamlMembers& members, std::string_view key) {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const YamlMember& member) { return member.key == key; });
  if (found == members.end() || found->value.IsNull()) return std::nullopt;
  return found->value;
}

// The name of a link.
std::string link_name(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  const std::string name = yaml_scalar(node, what, gathered);
  gathered.take_name(name, place_of(node));
  return name;
}

// The members of the map at a key; none without it.
YamlMembers members_if_there(const YamlMembers& parent, const std::string& key,
                             const SphereGatherer& gathered) {
  const auto node = find_member(parent, key);
  return node ? yaml_members(*node, key, gathered) : YamlMembers{};
}

// The name of the geometry that collision checks of an XRDF use.
std::string xrdf_geometry(const YamlMembers& root, const SphereGatherer& gathered) {
  const YamlMembers collision = members_if_there(root, "collision", gathered);
  const auto name = find_member(collision, "geometry");
  if (!name) gathered.refuse({}, "names no geometry for collision");
  return yaml_scalar(*name, "the name of a geometry", gathered);
}

// To YAML 1.1, as PyYAML reads it, that is octal; to YAML 1.2 it is decimal.
bool may_be_octal(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return text.size() > 1 && text.front() == '0' &&
         text.find_first_not_of("01234567") == std::string_view::npos &&
         text.find_first_not_of('0') != std::string_view::npos;
}

// A quoted number is a text to every reader of YAML.
double number(const Node& node, const std::string& what, const SphereGatherer& gathered) {
  std::optional<double> value;
  if (node.IsScalar() && node.Tag() != "!") value = finite_number(node.Scalar());
  if (!value) gathered.refuse(place_of(node), what + " is not a number");
  gathered.unless(!may_be_octal(node.Scalar()), place_of(node),
                  what + ", " + node.Scalar() + ", is octal to some readers and decimal to others");
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
  for (const auto& name : *listed) names.insert(link_name(name, "a link's name", gathered));
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

// Gathers the spheres and pairs of a file with these members, and of one beside it that it names.
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

// What cuRobo's own files say where nothing better is known: m/s^2 and rad/s^2, and their rates.
constexpr double kAcceleration = 15.0;
constexpr double kJerk = 500.0;

// Links that are not tested against a first one, with a reason each.
struct IgnoredLinks {
  std::string first;
  std::vector<std::string> others{};
  std::vector<std::string> reasons{};
};

// The first one of a pair is the one that comes first in `order`: cuRobo searches for it there
// only.
std::vector<IgnoredLinks> ignored_links(std::span<const DisabledPair> pairs,
                                        const std::vector<std::string>& order) {
  std::unordered_map<std::string, std::size_t> places;
  for (const std::string& link : order) places.try_emplace(link, places.size());
  const auto place = [&](const std::string& link) {
    const auto found = places.find(link);
    return found != places.end() ? found->second : places.size();
  };
  std::vector<IgnoredLinks> lists;
  std::unordered_map<std::string, std::size_t> list_of;
  for (const DisabledPair& pair : pairs) {
    const bool is_turned = place(pair.link_b) < place(pair.link_a);
    const std::string& first = is_turned ? pair.link_b : pair.link_a;
    const auto [known, is_new] = list_of.try_emplace(first, lists.size());
    if (is_new) lists.push_back({first});
    IgnoredLinks& list = lists[known->second];
    list.others.push_back(is_turned ? pair.link_a : pair.link_b);
    list.reasons.push_back(pair.reason.empty() ? "given" : pair.reason);
  }
  return lists;
}

// "REASON: a, b; REASON: c".
std::string reasons_of(const IgnoredLinks& list) {
  std::vector<std::pair<std::string, std::string>> groups;  // reasons, and whom they are of
  for (std::size_t i = 0; i < list.others.size(); ++i) {
    const auto known =
        std::ranges::find(groups, list.reasons[i], &std::pair<std::string, std::string>::first);
    if (known == groups.end()) {
      groups.emplace_back(list.reasons[i], list.others[i]);
    } else {
      known->second += ", " + list.others[i];
    }
  }
  std::string text;
  for (const auto& [reason, whom] : groups) {
    text += (text.empty() ? "" : "; ") + reason + ": " + whom;
  }
  return text;
}

// Ends of lines to readers of YAML 1.1, which yaml-cpp writes as they are.
bool has_unicode_break(std::string_view text) {
  return text.find("\xe2\x80\xa8") != text.npos || text.find("\xe2\x80\xa9") != text.npos;
}

// Writes members of maps, each map until it is closed.
class YamlWriter {
 public:
  // A new file.
  YamlWriter() { open(); }
  // A tree, with spheres in the place of one of its nodes.
  YamlWriter(const Node& tree, const Node& place, const std::vector<LinkSpheres>& links) {
    out_.SetNullFormat(YAML::LowerNull);
    put_tree(tree, place, links);
  }

  void open() {
    ++open_;
    out_ << YAML::BeginMap;
  }
  void open(const std::string& key) {
    put_key(key);
    open();
  }
  void close() {
    --open_;
    out_ << YAML::EndMap;
  }

  template <class Value>
  void put(const std::string& key, const Value& value) {
    put_key(key);
    put_value(value);
  }
  void put_true(const std::string& key) {
    put_key(key);
    out_ << "true";
  }
  void put_ignored(const std::string& key, const RobotSpheres& spheres) {
    std::vector<std::string> order;
    for (const LinkSpheres& link : spheres.links) order.push_back(link.link);
    const std::vector<IgnoredLinks> lists = ignored_links(spheres.self_collision_ignore, order);
    put_key(key);
    put_style(lists.empty());
    open();
    for (const IgnoredLinks& list : lists) {
      put(list.first, list.others);
      const std::string reasons = reasons_of(list);
      if (!has_unicode_break(reasons)) out_ << YAML::Comment(reasons);
    }
    close();
  }

  // A list of one map with one text.
  void put_modifier(const std::string& name, const std::string& text) {
    put_key("modifiers");
    out_ << YAML::BeginSeq << YAML::BeginMap;
    put(name, text);
    out_ << YAML::EndMap << YAML::EndSeq;
  }

  // Closes all maps.
  std::string text() {
    while (open_ > 0) close();
    return std::string(out_.c_str(), out_.size()) + "\n";
  }

 private:
  void put_key(const std::string& key) {
    out_ << YAML::Key;
    put_value(key);
    out_ << YAML::Value;
  }
  // Of the map or list that begins next. Empty ones stand in the line of their key.
  void put_style(bool is_flow) { out_ << (is_flow ? YAML::Flow : YAML::Block); }
  void put_quoted(const std::string& text) {
    if (has_unicode_break(text)) out_ << YAML::EscapeNonAscii;
    out_ << YAML::DoubleQuoted << text;
  }
  // A text that is one to every reader.
  void put_value(const std::string& text) {
    if (!is_plain_yaml(text)) return put_quoted(text);
    out_ << text;
  }
  void put_value(double number) { out_ << decimal(number); }
  template <class Item>
  void put_value(const std::vector<Item>& list) {
    out_ << YAML::Flow << YAML::BeginSeq;
    for (const Item& item : list) put_value(item);
    out_ << YAML::EndSeq;
  }
  void put_value(const std::map<std::string, double>& lengths) {
    put_style(lengths.empty());
    out_ << YAML::BeginMap;
    for (const auto& [link, length] : lengths) put(link, length);
    out_ << YAML::EndMap;
  }
  void put_value(const Sphere& sphere) {
    const Eigen::Vector3d& at = sphere.center;
    out_ << YAML::Flow << YAML::BeginMap;
    put("center", std::vector<double>{at.x(), at.y(), at.z()});
    put("radius", sphere.radius);
    out_ << YAML::EndMap;
  }
  void put_value(const std::vector<LinkSpheres>& links) {
    put_style(links.empty());
    out_ << YAML::BeginMap;
    for (const LinkSpheres& link : links) {
      put_key(link.link);
      put_style(link.spheres.empty());
      out_ << YAML::BeginSeq;
      for (const Sphere& sphere : link.spheres) put_value(sphere);
      out_ << YAML::EndSeq;
    }
    out_ << YAML::EndMap;
  }

  void put_tree(const Node& node, const Node& place, const std::vector<LinkSpheres>& links) {
    if (node.is(place)) return put_value(links);
    const bool is_flow = node.Style() == YAML::EmitterStyle::Flow;
    if (node.IsNull()) {
      out_ << YAML::Null;
      return;
    }
    const bool has_type = !node.Tag().empty() && node.Tag() != "?" && node.Tag() != "!";
    if (has_type) out_ << YAML::VerbatimTag(node.Tag());
    if (node.IsMap()) {
      put_style(is_flow);
      out_ << YAML::BeginMap;
      for (const auto& member : node) {
        out_ << YAML::Key;
        put_tree(member.first, place, links);
        out_ << YAML::Value;
        put_tree(member.second, place, links);
      }
      out_ << YAML::EndMap;
    } else if (node.IsSequence()) {
      put_style(is_flow);
      out_ << YAML::BeginSeq;
      for (const auto& item : node) put_tree(item, place, links);
      out_ << YAML::EndSeq;
    } else if (node.Tag() == "?") {
      out_ << node.Scalar();  // a number or a truth value is not put in quotes
    } else if (node.Tag() == "!") {
      put_quoted(node.Scalar());
    } else {
      put_value(node.Scalar());
    }
  }

  YAML::Emitter out_{};
  int open_ = 0;
};

std::vector<double> positions(const SphereFileContext& context) {
  std::vector<double> at = context.joint_positions;
  at.resize(context.joint_names.size(), 0.0);
  return at;
}

// Copies a document so that no two parts are the same node, as those of an anchor are: what is
// changed in it changes nowhere else.
class Unshared {
 public:
  explicit Unshared(const SphereGatherer& gathered, std::size_t text_length)
      : gathered_(gathered),
        nodes_left_((1U << 18) + 8 * text_length),
        bytes_left_((1U << 22) + 8 * text_length) {}

  // An anchor may hold another twice that does the same, and so on. Without aliases a text makes
  // neither more nodes than it has bytes nor eight times as many bytes, of tags that are written
  // out.
  Node copy(const Node& node, int depth = 0) {
    constexpr int kDeepest = 64;  // an anchor may hold itself
    const std::size_t bytes = (node.IsScalar() ? node.Scalar().size() : 0) + node.Tag().size();
    if (depth > kDeepest || nodes_left_ == 0 || bytes > bytes_left_) {
      gathered_.refuse(place_of(node), "is too deep, or too long with its aliases");
    }
    --nodes_left_;
    bytes_left_ -= bytes;
    Node result(node.Type());
    if (node.IsScalar()) result = node.Scalar();
    for (const auto& item : node) {
      if (node.IsSequence()) result.push_back(copy(item, depth + 1));
      if (!node.IsMap()) continue;
      const Node key = copy(item.first, depth + 1);
      result.force_insert(key, copy(item.second, depth + 1));
    }
    if (node.IsNull()) return result;
    result.SetTag(node.Tag());
    result.SetStyle(node.Style());
    return result;
  }

 private:
  const SphereGatherer& gathered_;
  std::size_t nodes_left_;
  std::size_t bytes_left_;
};

// Where things stand, by the keys from the root on; empty where a file has no place for them.
struct KeptPlaces {
  Keys spheres;
  Keys names{};    // of the links whose spheres count
  Keys ignored{};  // pairs
};

KeptPlaces places_in(const YamlMembers& root, SphereFormat format, const SphereGatherer& gathered) {
  if (format == SphereFormat::kXrdf) {
    KeptPlaces places{{"geometry", xrdf_geometry(root, gathered), "spheres"}};
    const bool has_self = !members_if_there(root, "self_collision", gathered).empty();
    if (has_self) places.ignored = {"self_collision", "ignore"};
    return places;
  }
  Keys way;  // as read_curobo() goes
  const YamlMembers inner = members_if_there(root, "robot_cfg", gathered);
  const bool has_kinematics =
      !members_if_there(inner.empty() ? root : inner, "kinematics", gathered).empty();
  if (has_kinematics && !inner.empty()) way.push_back("robot_cfg");
  if (has_kinematics) way.push_back("kinematics");
  const auto below = [&](const char* key) {
    Keys keys = way;
    keys.push_back(key);
    return keys;
  };
  return {below("collision_spheres"), below("collision_link_names"),
          has_kinematics ? below("self_collision_ignore") : Keys{}};
}

// With what the file says of spheres beside these: what it switches off, but for spheres of links
// that cuRobo is not told of and that get others, and all spheres of other links. What cannot be
// read is replaced.
std::vector<LinkSpheres> with_kept_spheres(std::vector<LinkSpheres> links, const YamlMembers& root,
                                           const fs::path& path, SphereGatherer old) {
  try {
    gather_spheres(root, path, old);
  } catch (const Error&) {
    return links;
  }
  std::map<std::string, std::size_t> places;
  for (const LinkSpheres& link : links) places.try_emplace(link.link, places.size());
  for (LinkSpheres& link : old.spheres.links) {
    const auto [place, is_other] = places.try_emplace(link.link, places.size());
    if (is_other) links.push_back(std::move(link));
    std::vector<Sphere>& all = links[place->second].spheres;
    const bool has_spheres = !is_other && !all.empty();
    for (const Sphere& sphere : old.left_out[place->first]) {
      if (sphere.radius <= 0.0 || !has_spheres) all.push_back(sphere);
    }
  }
  return links;
}

// The tree of an existing file, to which names and pairs are added.
class KeptYaml {
 public:
  KeptYaml(const Node& root, const RobotSpheres& spheres, const SphereGatherer& gathered)
      : root_(root), spheres_(spheres), gathered_(gathered) {}

  std::optional<Node> value_at(const Keys& keys) const {
    Node at;
    at.reset(root_);
    for (const std::string& key : keys) {
      const YamlMembers members = yaml_members(at, "a part", gathered_);
      const auto found = std::ranges::find(members, key, &YamlMember::key);
      if (found == members.end()) return std::nullopt;
      at.reset(found->value);
    }
    return at;
  }

  // Links with spheres are to be examined.
  void add_names(const Keys& keys) {
    std::optional<Node> names = keys.empty() ? std::nullopt : value_at(keys);
    if (!names || !names->IsSequence()) return;
    for (const Node& name : *names) {
      order_.push_back(link_name(name, "a link's name", gathered_));
    }
    const std::set<std::string> listed(order_.begin(), order_.end());
    for (const LinkSpheres& link : spheres_.links) {
      if (link.spheres.empty() || listed.contains(link.link)) continue;
      order_.push_back(link.link);
      names->push_back(link.link);
    }
  }

  // Those that the file does not ignore yet, in either order.
  void add_pairs(const Keys& keys) {
    if (keys.empty()) return;
    std::optional<Node> ignored = value_at(keys);
    const bool has_lists = ignored && !ignored->IsNull();
    const std::vector<IgnoredLinks> missing =
        missing_pairs(has_lists ? yaml_members(*ignored, keys.back(), gathered_) : YamlMembers{});
    if (missing.empty()) return;
    if (!ignored) {
      Node parent = *value_at(Keys(keys.begin(), keys.end() - 1));
      ignored.emplace(parent[keys.back()]);
    }
    for (const IgnoredLinks& list : missing) {
      Node others = (*ignored)[list.first];
      if (!others.IsSequence()) others.SetStyle(YAML::EmitterStyle::Flow);
      for (const std::string& other : list.others) others.push_back(other);
    }
  }

 private:
  std::vector<IgnoredLinks> missing_pairs(const YamlMembers& lists) {
    std::set<std::pair<std::string, std::string>> known;
    for (const auto& [link, key, others] : lists) {
      gathered_.unless(others.IsSequence() || others.IsNull(), place_of(others),
                       "ignored links are not a list");
      for (const Node& other : others) {
        gathered_.take_name(link, place_of(other));
        const std::string name = link_name(other, "an ignored link", gathered_);
        known.insert(std::minmax(link, name));
      }
    }
    std::vector<DisabledPair> missing;
    for (const DisabledPair& pair : spheres_.self_collision_ignore) {
      if (known.insert(std::minmax(pair.link_a, pair.link_b)).second) missing.push_back(pair);
    }
    for (const LinkSpheres& link : spheres_.links) order_.push_back(link.link);
    return ignored_links(missing, order_);
  }

  const Node root_;
  const RobotSpheres& spheres_;
  const SphereGatherer& gathered_;
  std::vector<std::string> order_{};  // of links
};

}  // namespace

SphereFormatFile read_sphere_yaml(std::string_view text, const fs::path& path) {
  SphereGatherer gathered(path.string(), text.size());
  const YamlMembers root = yaml_members(yaml_document(text, gathered), "the file", gathered);
  const SphereFormat format = gather_spheres(root, path, gathered);
  return {format, std::move(gathered.spheres)};
}

std::string with_spheres(std::string_view text, const fs::path& path, const RobotSpheres& spheres,
                         SphereFormat format) {
  text.remove_prefix(byte_order_mark(text).size());
  const SphereGatherer gathered(path.string(), text.size());
  gathered.unless(is_utf8(text), {}, "is not UTF-8");
  const Node document = yaml_document(text, gathered);
  const YamlMembers members = yaml_members(document, "the file", gathered);
  const KeptPlaces places = places_in(members, format, gathered);
  const Node tree = Unshared(gathered, text.size()).copy(document);
  KeptYaml kept(tree, spheres, gathered);
  const auto place = kept.value_at(places.spheres);
  gathered.unless(place.has_value(), {}, "has no place for spheres");
  kept.add_names(places.names);
  kept.add_pairs(places.ignored);
  YamlWriter out(
      tree, *place,
      with_kept_spheres(spheres.links, members, path, SphereGatherer(path.string(), text.size())));
  std::string result = out.text();
  try {
    YAML::Load(result);
  } catch (const YAML::Exception&) {
    // Control characters are escaped, and a key has at most 1024 characters.
    gathered.refuse({}, "has a link whose name is too long for a key of YAML");
  }
  return result;
}

std::string sphere_curobo(const RobotSpheres& spheres, const SphereFileContext& context) {
  std::vector<std::string> with_spheres;
  for (const LinkSpheres& link : spheres.links) {
    if (!link.spheres.empty()) with_spheres.push_back(link.link);
  }
  const std::vector<double> ones(context.joint_names.size(), 1.0);
  YamlWriter out;
  out.open("robot_cfg");
  out.open("kinematics");
  if (!context.urdf.empty()) {
    out.put("urdf_path", context.urdf.generic_string());
    out.put("asset_root_path", context.urdf.parent_path().generic_string());
  }
  out.put("base_link", context.base_link);
  out.put("ee_link", context.tool_link);
  out.put("collision_link_names", with_spheres);
  out.put("collision_spheres", spheres.links);
  if (spheres.collision_buffers.empty()) {
    out.put("collision_sphere_buffer", spheres.collision_buffer);
  } else {
    out.put("collision_sphere_buffer", spheres.collision_buffers);
  }
  out.put_ignored("self_collision_ignore", spheres);
  out.put("self_collision_buffer", spheres.self_collision_buffer);
  out.put_true("use_global_cumul");
  out.put("lock_joints", std::map<std::string, double>());
  out.put("extra_links", std::map<std::string, double>());
  out.open("cspace");
  out.put("joint_names", context.joint_names);
  out.put("retract_config", positions(context));
  out.put("null_space_weight", ones);
  out.put("cspace_distance_weight", ones);
  out.put("max_acceleration", kAcceleration);
  out.put("max_jerk", kJerk);
  return out.text();
}

std::string sphere_xrdf(const RobotSpheres& spheres, const SphereFileContext& context) {
  const std::string geometry = "collision_spheres";
  const std::size_t joints = context.joint_names.size();
  const std::vector<double> at = positions(context);
  YamlWriter out;
  out.put("format", std::string("xrdf"));
  out.put("format_version", 1.0);
  if (!context.base_link.empty()) {
    out.put_modifier("set_base_frame", context.base_link);
  }
  out.open("default_joint_positions");
  for (std::size_t joint = 0; joint < joints; ++joint) {
    out.put(context.joint_names[joint], at[joint]);
  }
  out.close();
  out.open("cspace");
  out.put("joint_names", context.joint_names);
  out.put("acceleration_limits", std::vector<double>(joints, kAcceleration));
  out.put("jerk_limits", std::vector<double>(joints, kJerk));
  out.close();
  out.put("tool_frames", context.tool_link.empty() ? Keys{} : Keys{context.tool_link});
  std::map<std::string, double> distances = spheres.collision_buffers;
  if (distances.empty() && spheres.collision_buffer != 0.0) {
    for (const LinkSpheres& link : spheres.links) distances[link.link] = spheres.collision_buffer;
  }
  out.open("collision");
  out.put("geometry", geometry);
  out.put("buffer_distance", distances);
  out.close();
  out.open("self_collision");
  out.put("geometry", geometry);
  out.put("buffer_distance", spheres.self_collision_buffer);
  out.put_ignored("ignore", spheres);
  out.close();
  out.open("geometry");
  out.open(geometry);
  out.put("spheres", spheres.links);
  return out.text();
}

}  // namespace spherule::internal
