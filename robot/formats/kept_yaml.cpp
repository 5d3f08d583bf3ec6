// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/text.h"
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"
#include "robot/formats/yaml_compare.h"
#include "robot/formats/yaml_edit.h"
#include "robot/formats/yaml_nodes.h"
#include "robot/formats/yaml_rewriter.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace spherule::internal {
namespace {

using YAML::Node;
using Keys = std::vector<std::string>;

// Where things stand, by the keys from the root on; empty where a file has no place for them.
struct KeptPlaces {
  Keys spheres;
  Keys names;    // of the links whose spheres count
  Keys ignored;  // pairs
};

KeptPlaces places_in(const YamlMembers& root, SphereFormat format, const SphereGatherer& gathered) {
  if (format == SphereFormat::kXrdf) {
    KeptPlaces places{{"geometry", xrdf_geometry(root, gathered), "spheres"}, {}, {}};
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

// The members of the map that holds the last of the keys, each with the key that follows.
std::vector<YamlPlace> siblings(const Node& root, const Keys& keys,
                                const SphereGatherer& gathered) {
  std::vector<YamlPlace> result;
  Node map;
  map.reset(root);
  std::optional<Node> next_above;
  for (std::size_t depth = 0;; ++depth) {
    const YamlMembers members = yaml_members(map, "a part", gathered);
    result.clear();
    for (std::size_t i = 0; i < members.size(); ++i) {
      const bool is_last = i + 1 == members.size();
      result.push_back({members[i].written_key, members[i].value,
                        is_last ? next_above : std::optional(members[i + 1].written_key)});
    }
    if (depth + 1 == keys.size()) return result;
    const auto found = std::find_if(result.begin(), result.end(), [&](const YamlPlace& place) {
      return place.key.Scalar() == keys[depth];
    });
    if (found == result.end()) return {};
    map.reset(found->value);
    // Not by assignment, which would make the key that it holds another one in the document.
    next_above.reset();
    if (found->next) next_above.emplace(*found->next);
  }
}

std::optional<YamlPlace> place_at(const Node& root, const Keys& keys,
                                  const SphereGatherer& gathered) {
  for (const YamlPlace& place : siblings(root, keys, gathered)) {
    if (place.key.Scalar() == keys.back()) return place;
  }
  return std::nullopt;
}

// The map around the last of the keys, which are made where they are missing.
Node parent_of(const Node& root, const Keys& keys) {
  Node at;
  at.reset(root);
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) at.reset(at[keys[i]]);
  return at;
}

// With what the file says of spheres beside these: what it switches off, but for spheres of links
// that cuRobo is not told of and that get others, and all spheres of other links. What cannot be
// read is replaced.
RobotSpheres with_kept_spheres(RobotSpheres spheres, const YamlMembers& root,
                               const std::filesystem::path& path, SphereGatherer old) {
  try {
    gather_spheres(root, path, old);
  } catch (const Error&) {
    return spheres;
  }
  std::map<std::string, std::size_t> places;
  for (const LinkSpheres& link : spheres.links) places.try_emplace(link.link, places.size());
  for (LinkSpheres& link : old.spheres.links) {
    const auto [place, is_other] = places.try_emplace(link.link, places.size());
    if (is_other) spheres.links.push_back(std::move(link));
    std::vector<Sphere>& all = spheres.links[place->second].spheres;
    const bool has_spheres = !is_other && !all.empty();
    for (const Sphere& sphere : old.left_out[place->first]) {
      if (sphere.radius <= 0.0 || !has_spheres) all.push_back(sphere);
    }
  }
  return spheres;
}

// Makes the changes twice, in the text and in what was read of it, which must then agree.
class KeptYaml {
 public:
  KeptYaml(std::string_view text, const RobotSpheres& spheres, const RobotSpheres& with_kept,
           const KeptPlaces& places, const SphereGatherer& gathered)
      : spheres_(spheres),
        with_kept_(with_kept),
        places_(places),
        gathered_(gathered),
        document_(yaml_document(text, gathered)),
        expected_(unshared_yaml(document_, text.size())),
        edit_(text),
        length_(text.size()) {}

  // Nothing where the style of the text does not allow it.
  std::optional<std::string> changed() {
    const auto place = place_at(document_, places_.spheres, gathered_);
    gathered_.unless(place.has_value(), {}, "has no place for spheres");
    const std::string block =
        yaml_spheres(with_kept_, static_cast<int>(edit_.column(place->key)) + 2);
    edit_.replace_by_block(*place, block);
    parent_of(expected_, places_.spheres)[places_.spheres.back()] = YAML::Load(block);
    add_names();
    if (!places_.ignored.empty()) add_pairs();
    if (!edit_.is_possible()) return std::nullopt;
    std::string text = edit_.result();
    try {
      const std::optional<Node> read = only_document(text);
      const std::size_t length = length_ + text.size();
      if (read && is_same_yaml(*read, expected_, length)) return text;
    } catch (const YAML::Exception&) {
      return std::nullopt;  // an anchor stood where the changes were made
    }
    return std::nullopt;
  }

 private:
  // Links with spheres are to be examined.
  void add_names() {
    if (places_.names.empty()) return;
    const auto place = place_at(document_, places_.names, gathered_);
    if (!place || !place->value.IsSequence()) return;
    for (const Node& name : place->value) {
      order_.push_back(yaml_scalar(name, "a link's name", gathered_));
      gathered_.take_name(order_.back(), place_of(name));
    }
    const std::set<std::string> listed(order_.begin(), order_.end());
    std::vector<std::string> added;
    for (const LinkSpheres& link : spheres_.links) {
      if (link.spheres.empty() || listed.contains(link.link)) continue;
      order_.push_back(link.link);
      added.push_back(yaml_text(link.link));
      parent_of(expected_, places_.names)[places_.names.back()].push_back(YAML::Load(added.back()));
    }
    if (!added.empty()) edit_.append(*place, added, {}, {});
  }

  // Those that the file does not ignore yet, in either order.
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

  void add_pairs() {
    const auto place = place_at(document_, places_.ignored, gathered_);
    const bool has_lists = place && !place->value.IsNull();
    const YamlMembers lists =
        has_lists ? yaml_members(place->value, places_.ignored.back(), gathered_) : YamlMembers{};
    std::vector<IgnoredLinks> missing = missing_pairs(lists);
    if (missing.empty()) return;
    const auto is_listed = [&](const IgnoredLinks& list) {
      return std::any_of(lists.begin(), lists.end(),
                         [&](const YamlMember& member) { return member.key == list.first; });
    };
    const auto new_lists = std::partition(missing.begin(), missing.end(), is_listed);
    const std::vector<IgnoredLinks> added(new_lists, missing.end());
    missing.erase(new_lists, missing.end());
    Node ignored = parent_of(expected_, places_.ignored)[places_.ignored.back()];
    for (const IgnoredLinks& list : added) {
      ignored[list.first] = YAML::Load(yaml_ignored(list))[list.first];
    }
    // Lines that go to the same place stand in the order in which they are added.
    const bool is_in_braces = has_lists && place->value.Style() != YAML::EmitterStyle::Block;
    if (!added.empty() && is_in_braces) {
      const std::size_t indent = indent_in_braces(*place, lists);
      edit_.add_in_braces(place->value, lines_of(added, indent, ","), indent);
    }
    add_to_lists(missing, ignored);
    if (!added.empty() && !is_in_braces) add_lists(place, lists, added);
  }

  void add_lists(const std::optional<YamlPlace>& place, const YamlMembers& lists,
                 const std::vector<IgnoredLinks>& added) {
    if (!lists.empty()) {
      edit_.add_below(*place, lines_of(added, edit_.column(lists.front().written_key), ""));
    } else if (place) {
      edit_.replace_by_block(*place, lines_of(added, edit_.column(place->key) + 2, ""));
    } else {
      const Node beside = siblings(document_, places_.ignored, gathered_).front().key;
      const std::size_t indent = edit_.column(beside);
      edit_.add_above(beside, std::string(indent, ' ') + places_.ignored.back() + ":\n" +
                                  lines_of(added, indent + 2, ""));
    }
  }

  void add_to_lists(const std::vector<IgnoredLinks>& missing, Node& ignored) {
    if (missing.empty()) return;
    Keys keys = places_.ignored;
    keys.emplace_back();
    for (const YamlPlace& place : siblings(document_, keys, gathered_)) {
      const auto found =
          std::find_if(missing.begin(), missing.end(),
                       [&](const IgnoredLinks& list) { return list.first == place.key.Scalar(); });
      if (found == missing.end()) continue;
      std::vector<std::string> items;
      std::vector<std::string> reasons;
      for (std::size_t i = 0; i < found->others.size(); ++i) {
        items.push_back(yaml_text(found->others[i]));
        reasons.push_back(yaml_comment(found->reasons[i]));
        ignored[found->first].push_back(YAML::Load(items.back()));
      }
      edit_.append(place, items, reasons, yaml_reasons(*found));
    }
  }

  std::size_t indent_in_braces(const YamlPlace& place, const YamlMembers& lists) {
    const bool is_below =
        !lists.empty() && lists.front().written_key.Mark().line > place.value.Mark().line;
    return is_below ? edit_.column(lists.front().written_key) : edit_.column(place.key) + 2;
  }

  static std::string lines_of(const std::vector<IgnoredLinks>& lists, std::size_t indent,
                              const std::string& separator) {
    std::string lines;
    for (const IgnoredLinks& list : lists) {
      lines += std::string(indent, ' ') + yaml_ignored(list) + separator + "  " +
               yaml_reasons(list) + "\n";
    }
    return lines;
  }

  const RobotSpheres& spheres_;
  const RobotSpheres& with_kept_;
  const KeptPlaces& places_;
  const SphereGatherer& gathered_;
  Node document_;
  Node expected_;
  YamlEdit edit_;
  std::size_t length_;
  std::vector<std::string> order_;  // of links
};

}  // namespace

std::string with_spheres(std::string_view text, const std::filesystem::path& path,
                         const RobotSpheres& spheres, SphereFormat format) {
  // Columns of the first line are counted behind it.
  const std::string mark(byte_order_mark(text));
  text.remove_prefix(mark.size());
  const SphereGatherer gathered(path.string(), text.size());
  const Node document = yaml_document(text, gathered);
  const YamlMembers root = yaml_members(document, "the file", gathered);
  const KeptPlaces places = places_in(root, format, gathered);
  const RobotSpheres with_kept =
      with_kept_spheres(spheres, root, path, SphereGatherer(path.string(), text.size()));
  const auto changed = [&](std::string_view old) -> std::optional<std::string> {
    try {
      return KeptYaml(old, spheres, with_kept, places, gathered).changed();
    } catch (const YAML::Exception&) {
      // Control characters are escaped, and a key has at most 1024 characters.
      gathered.refuse({}, "has a link whose name is too long for a key of YAML");
    }
  };
  if (const auto result = changed(text)) return mark + *result;
  const auto anew = changed(rewritten_yaml(document, with_kept, places.spheres, gathered));
  gathered.unless(anew.has_value(), {}, "has a style in which it cannot be kept");
  return mark + *anew;
}

}  // namespace spherule::internal
