// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "robot/files/robot_description.h"
#include "robot/files/urdf_files.h"
#include "robot/files/xml_file.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

using internal::XmlElement;

std::vector<std::string> names_of(const XmlElement& group, std::string_view tag) {
  std::vector<std::string> names;
  for (const XmlElement& child : group.children(tag)) names.push_back(child.needed("name"));
  return names;
}

// Warns once of each kind of element that is not known there.
class UnknownElements {
 public:
  void in(const XmlElement& element, std::initializer_list<std::string_view> known) {
    for (const XmlElement& child : element.children()) {
      const std::string tag(child.tag());
      if (std::find(known.begin(), known.end(), tag) != known.end()) continue;
      if (tag.starts_with("xacro:")) {
        child.refuse(
            "this is for xacro, which makes an SRDF of it: rename the file, so that it "
            "ends in .xacro");
      }
      if (!warned_.emplace(element.tag(), tag).second) continue;
      warnings_.push_back(child.place() + "it is not known there and is ignored");
    }
  }

  std::vector<std::string> warnings() && { return std::move(warnings_); }

 private:
  std::set<std::pair<std::string, std::string>> warned_;
  std::vector<std::string> warnings_;
};

// Refuses what was there before.
template <class Key>
void remember(std::set<Key>& known, Key key, const XmlElement& element) {
  if (!known.insert(std::move(key)).second) element.refuse("there is one of that name already");
}

JointGroup group_of(const XmlElement& element) {
  JointGroup group{.name = element.needed("name"),
                   .links = names_of(element, "link"),
                   .joints = names_of(element, "joint"),
                   .subgroups = names_of(element, "group")};
  for (const XmlElement& chain : element.children("chain")) {
    group.chains.push_back({chain.needed("base_link"), chain.needed("tip_link")});
  }
  return group;
}

// Refuses groups that are not there and, by taking away again and again those whose groups are
// known to end, groups within themselves.
void check_subgroups(const std::vector<XmlElement>& elements,
                     const std::vector<JointGroup>& groups) {
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < groups.size(); ++i) index[groups[i].name] = i;
  std::vector<std::vector<std::size_t>> parents(groups.size());
  std::vector<std::size_t> open(groups.size(), 0);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const std::string& name : groups[i].subgroups) {
      const auto found = index.find(name);
      if (found == index.end()) elements[i].refuse("there is no group '" + name + "'");
      parents[found->second].push_back(i);
      ++open[i];
    }
  }
  std::vector<std::size_t> ended;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (open[i] == 0) ended.push_back(i);
  }
  for (std::size_t next = 0; next < ended.size(); ++next) {
    for (const std::size_t parent : parents[ended[next]]) {
      if (--open[parent] == 0) ended.push_back(parent);
    }
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (open[i] > 0) elements[i].refuse("it is within itself, or a group in it is");
  }
}

GroupState state_of(const XmlElement& element) {
  GroupState state{.name = element.needed("name"), .group = element.needed("group")};
  std::set<std::string> known;
  for (const XmlElement& joint : element.children("joint")) {
    state.joints.push_back({joint.needed("name"), joint.needed_numbers("value")});
    remember(known, state.joints.back().joint, joint);
  }
  return state;
}

DisabledPair pair_of(const XmlElement& element) {
  DisabledPair pair{element.needed("link1"), element.needed("link2"),
                    element.attribute("reason").value_or("")};
  if (pair.link_a == pair.link_b) element.refuse("it is a link with itself");
  return pair;
}

LinkSpheres spheres_of(const XmlElement& element) {
  LinkSpheres result{element.needed("link"), {}};
  for (const XmlElement& entry : element.children("sphere")) {
    const Sphere sphere{entry.needed_vector("center"), entry.needed_number("radius")};
    if (sphere.radius < 0.0) entry.refuse("its radius is below zero");
    if (sphere.radius > kMaxCoordinate || sphere.center.cwiseAbs().maxCoeff() > kMaxCoordinate) {
      entry.refuse("its numbers are too large");
    }
    if (sphere.radius > 0.0) result.spheres.push_back(sphere);
  }
  return result;
}

}  // namespace

SemanticDescription read_srdf(const std::filesystem::path& path) {
  const internal::XmlFile file(path.string(), internal::urdf_text(path), "robot");
  const XmlElement root = file.root();
  SemanticDescription result{.robot_name = root.needed("name")};
  UnknownElements unknown;
  unknown.in(root, {"group", "group_state", "end_effector", "virtual_joint", "passive_joint",
                    "joint_property", "disable_default_collisions", "enable_collisions",
                    "disable_collisions", "link_sphere_approximation"});

  const std::vector<XmlElement> groups = root.children("group");
  std::set<std::string> group_names;
  for (const XmlElement& element : groups) {
    unknown.in(element, {"link", "joint", "chain", "group"});
    result.groups.push_back(group_of(element));
    remember(group_names, result.groups.back().name, element);
  }
  check_subgroups(groups, result.groups);
  const auto require_group = [&](const std::string& name, const XmlElement& element) {
    if (!group_names.contains(name)) element.refuse("there is no group '" + name + "'");
  };

  std::set<std::pair<std::string, std::string>> state_names;
  for (const XmlElement& element : root.children("group_state")) {
    unknown.in(element, {"joint"});
    const GroupState& state = result.group_states.emplace_back(state_of(element));
    require_group(state.group, element);
    remember(state_names, {state.group, state.name}, element);
  }
  std::set<std::string> effector_names;
  for (const XmlElement& element : root.children("end_effector")) {
    const EndEffector& effector = result.end_effectors.emplace_back(
        EndEffector{element.needed("name"), element.needed("group"), element.needed("parent_link"),
                    element.attribute("parent_group").value_or("")});
    require_group(effector.group, element);
    if (!effector.parent_group.empty()) require_group(effector.parent_group, element);
    remember(effector_names, effector.name, element);
  }
  for (const XmlElement& element : root.children("disable_collisions")) {
    result.disabled_pairs.push_back(pair_of(element));
  }
  for (const XmlElement& element : root.children("disable_default_collisions")) {
    result.links_disabled_by_default.push_back(element.needed("link"));
  }
  for (const XmlElement& element : root.children("enable_collisions")) {
    const DisabledPair pair = pair_of(element);
    result.enabled_pairs.emplace_back(pair.link_a, pair.link_b);
  }
  std::set<std::string> approximated;
  for (const XmlElement& element : root.children("link_sphere_approximation")) {
    unknown.in(element, {"sphere"});
    result.sphere_approximations.push_back(spheres_of(element));
    remember(approximated, result.sphere_approximations.back().link, element);
  }
  result.warnings = std::move(unknown).warnings();
  return result;
}

namespace {

using Names = std::pair<std::string, std::string>;

Names in_order(const std::string& a, const std::string& b) {
  return std::minmax(a, b);
}

}  // namespace

std::vector<DisabledPair> disabled_among(const SemanticDescription& semantics,
                                         std::span<const std::string> links) {
  std::vector<DisabledPair> pairs = semantics.disabled_pairs;
  std::set<Names> decided;
  for (const DisabledPair& pair : pairs) decided.insert(in_order(pair.link_a, pair.link_b));
  for (const auto& [first, second] : semantics.enabled_pairs) {
    decided.insert(in_order(first, second));
  }
  const std::set<std::string> by_default(semantics.links_disabled_by_default.begin(),
                                         semantics.links_disabled_by_default.end());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!by_default.contains(links[i])) continue;
    for (std::size_t j = 0; j < links.size(); ++j) {
      // Of two such links the pair is the first one's.
      if (i == j || (j < i && by_default.contains(links[j]))) continue;
      if (decided.contains(in_order(links[i], links[j]))) continue;
      pairs.push_back({links[i], links[j], std::string(kDisabledByDefault)});
    }
  }
  return pairs;
}

std::vector<std::pair<std::string, std::string>> enabled_only(
    const SemanticDescription& semantics) {
  std::set<Names> disabled;
  for (const DisabledPair& pair : semantics.disabled_pairs) {
    disabled.insert(in_order(pair.link_a, pair.link_b));
  }
  std::vector<Names> pairs = semantics.enabled_pairs;
  std::erase_if(pairs, [&](const Names& pair) {
    return disabled.contains(in_order(pair.first, pair.second));
  });
  return pairs;
}

std::vector<std::string> unknown_names(const SemanticDescription& semantics,
                                       const RobotModel& robot) {
  std::vector<std::string> unknown;
  const auto add = [&](const std::string& where, const char* what, const std::string& name) {
    if (unknown.size() < kMostUnknownNames) unknown.push_back(where + what + name);
  };
  const auto check_link = [&](const std::string& where, const std::string& name) {
    if (robot.find_link(name) < 0) add(where, ": there is no link ", name);
  };
  const auto check_joint = [&](const std::string& where, const std::string& name) {
    if (robot.find_joint(name) < 0) add(where, ": there is no joint ", name);
  };
  for (const JointGroup& group : semantics.groups) {
    const std::string where = "group " + group.name;
    for (const std::string& link : group.links) check_link(where, link);
    for (const std::string& joint : group.joints) check_joint(where, joint);
    for (const LinkChain& chain : group.chains) {
      check_link(where, chain.base_link);
      check_link(where, chain.tip_link);
    }
  }
  for (const GroupState& state : semantics.group_states) {
    const std::string where = "state " + state.name;
    for (const JointState& joint : state.joints) check_joint(where, joint.joint);
  }
  for (const EndEffector& effector : semantics.end_effectors) {
    check_link("end effector " + effector.name, effector.parent_link);
  }
  for (const DisabledPair& pair : semantics.disabled_pairs) {
    check_link("disabled pair", pair.link_a);
    check_link("disabled pair", pair.link_b);
  }
  for (const std::string& link : semantics.links_disabled_by_default) {
    check_link("disabled by default", link);
  }
  for (const auto& [first, second] : semantics.enabled_pairs) {
    check_link("enabled pair", first);
    check_link("enabled pair", second);
  }
  for (const LinkSpheres& spheres : semantics.sphere_approximations) {
    check_link("sphere approximation", spheres.link);
  }
  return unknown;
}

}  // namespace spherule
