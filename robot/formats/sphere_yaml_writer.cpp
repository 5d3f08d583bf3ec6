// SPDX-License-Identifier: BSD-3-Clause
// The files of cuRobo and XRDF that are written: new ones, and existing ones with other spheres.
#include "base/error.h"
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"
#include "robot/formats/yaml_nodes.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace spherule::internal {
namespace {

using YAML::Node;
using Keys = std::vector<std::string>;

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

  Node copy(const Node& node) {
    take(node, 0);
    return copied(node);
  }

 private:
  static constexpr int kDeepest = 64;  // an anchor may hold itself

  // An anchor may hold another twice that does the same, and so on. Without aliases a text makes
  // neither more nodes than it has bytes nor eight times as many bytes, of tags that are written
  // out.
  void take(const Node& node, int depth) {
    const std::size_t bytes = (node.IsScalar() ? node.Scalar().size() : 0) + node.Tag().size();
    if (depth > kDeepest || nodes_left_ == 0 || bytes > bytes_left_) {
      gathered_.refuse(place_of(node), "is too deep, or too long with its aliases");
    }
    --nodes_left_;
    bytes_left_ -= bytes;
    for (const auto& item : node) {
      if (node.IsSequence()) take(item, depth + 1);
      if (!node.IsMap()) continue;
      take(item.first, depth + 1);
      take(item.second, depth + 1);
    }
  }

  static Node copied(const Node& node) {
    Node copy(node.Type());
    if (node.IsScalar()) copy = node.Scalar();
    for (const auto& item : node) {
      if (node.IsSequence()) copy.push_back(copied(item));
      if (node.IsMap()) copy.force_insert(copied(item.first), copied(item.second));
    }
    if (node.IsNull()) return copy;
    copy.SetTag(node.Tag());
    copy.SetStyle(node.Style());
    return copy;
  }

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
                                           const std::filesystem::path& path, SphereGatherer old) {
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
      order_.push_back(yaml_scalar(name, "a link's name", gathered_));
      gathered_.take_name(order_.back(), place_of(name));
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
        const std::string name = yaml_scalar(other, "an ignored link", gathered_);
        gathered_.take_name(link, place_of(other));
        gathered_.take_name(name, place_of(other));
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

std::string with_spheres(std::string_view text, const std::filesystem::path& path,
                         const RobotSpheres& spheres, SphereFormat format) {
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
