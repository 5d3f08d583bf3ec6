// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/format_text.h"
#include "robot/formats/sphere_documents.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

template <class Range, class Text>
std::string flow_list(const Range& range, const Text& text_of) {
  std::string text = "[";
  for (const auto& item : range) text.append(text.size() == 1 ? "" : ", ").append(text_of(item));
  return text + "]";
}

std::string names(const std::vector<std::string>& list) {
  return flow_list(list, [](const std::string& name) { return yaml_text(name); });
}

std::string numbers(const std::vector<double>& list) {
  return flow_list(list, [](double value) { return decimal(value); });
}

std::string same(double value, std::size_t count) {
  return numbers(std::vector<double>(count, value));
}

std::string buffers(const std::map<std::string, double>& lengths, const std::string& indent) {
  if (lengths.empty()) return " {}\n";
  std::string text = "\n";
  for (const auto& [link, length] : lengths) {
    text += indent + yaml_text(link) + ": " + decimal(length) + "\n";
  }
  return text;
}

std::string ignored(const RobotSpheres& spheres, const std::string& indent) {
  if (spheres.self_collision_ignore.empty()) return " {}\n";
  std::vector<std::string> order;
  for (const LinkSpheres& link : spheres.links) order.push_back(link.link);
  std::string text = "\n";
  for (const IgnoredLinks& list : ignored_links(spheres.self_collision_ignore, order)) {
    text += indent + yaml_ignored(list) + "  " + yaml_reasons(list) + "\n";
  }
  return text;
}

std::vector<double> positions(const SphereFileContext& context) {
  std::vector<double> at = context.joint_positions;
  at.resize(context.joint_names.size(), 0.0);
  return at;
}

// What cuRobo's own files say where nothing better is known: m/s^2 and rad/s^2, and their rates.
constexpr double kAcceleration = 15.0;
constexpr double kJerk = 500.0;

}  // namespace

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

std::string yaml_ignored(const IgnoredLinks& list) {
  return yaml_text(list.first) + ": " + names(list.others);
}

std::string yaml_reasons(const IgnoredLinks& list) {
  std::vector<std::pair<std::string, std::string>> groups;  // reasons, and whom they are of
  for (std::size_t i = 0; i < list.others.size(); ++i) {
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return group.first == list.reasons[i];
    });
    if (known == groups.end()) {
      groups.emplace_back(list.reasons[i], list.others[i]);
    } else {
      known->second += ", " + list.others[i];
    }
  }
  std::string text;
  for (const auto& [reason, whom] : groups) {
    text += (text.empty() ? "# " : "; ") + reason + ": " + whom;
  }
  return yaml_comment(std::move(text));
}

std::string yaml_comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return text;
}

std::string yaml_spheres(const RobotSpheres& spheres, int indent) {
  const std::string space(static_cast<std::size_t>(indent), ' ');
  if (spheres.links.empty()) return space + "{}\n";
  std::string text;
  for (const LinkSpheres& link : spheres.links) {
    text += space + yaml_text(link.link) + (link.spheres.empty() ? ": []\n" : ":\n");
    for (const Sphere& sphere : link.spheres) {
      text += space + "  - {center: [" + decimals(sphere.center, ", ") +
              "], radius: " + decimal(sphere.radius) + "}\n";
    }
  }
  return text;
}

std::string sphere_curobo(const RobotSpheres& spheres, const SphereFileContext& context) {
  std::vector<std::string> with_spheres;
  for (const LinkSpheres& link : spheres.links) {
    if (!link.spheres.empty()) with_spheres.push_back(link.link);
  }
  const std::size_t joints = context.joint_names.size();
  std::string text = "robot_cfg:\n  kinematics:\n";
  // A value on the line of its key, or (put_block) a block below it.
  const auto put_block = [&](const char* key, const std::string& value) {
    text.append("    ").append(key).append(":").append(value);
  };
  const auto put = [&](const char* key, const std::string& value) {
    put_block(key, std::string(1, ' ').append(value).append(1, '\n'));
  };
  if (!context.urdf.empty()) {
    put("urdf_path", yaml_text(context.urdf.generic_string()));
    put("asset_root_path", yaml_text(context.urdf.parent_path().generic_string()));
  }
  put("base_link", yaml_text(context.base_link));
  put("ee_link", yaml_text(context.tool_link));
  put("collision_link_names", names(with_spheres));
  put_block("collision_spheres", std::string(1, '\n').append(yaml_spheres(spheres, 6)));
  if (spheres.collision_buffers.empty()) {
    put("collision_sphere_buffer", decimal(spheres.collision_buffer));
  } else {
    put_block("collision_sphere_buffer", buffers(spheres.collision_buffers, "      "));
  }
  put_block("self_collision_ignore", ignored(spheres, "      "));
  put_block("self_collision_buffer", buffers(spheres.self_collision_buffer, "      "));
  put("use_global_cumul", "true");
  put("lock_joints", "{}");
  put("extra_links", "{}");
  put_block("cspace", "\n");
  const auto put_joint = [&](const char* key, const std::string& value) {
    text += std::string("      ") + key + ": " + value + "\n";
  };
  put_joint("joint_names", names(context.joint_names));
  put_joint("retract_config", numbers(positions(context)));
  put_joint("null_space_weight", same(1.0, joints));
  put_joint("cspace_distance_weight", same(1.0, joints));
  put_joint("max_acceleration", decimal(kAcceleration));
  put_joint("max_jerk", decimal(kJerk));
  return text;
}

std::string sphere_xrdf(const RobotSpheres& spheres, const SphereFileContext& context) {
  const std::size_t joints = context.joint_names.size();
  const std::vector<double> at = positions(context);
  std::string text = "format: xrdf\nformat_version: 1.0\n\n";
  if (!context.base_link.empty()) {
    text += "modifiers:\n  - set_base_frame: " + yaml_text(context.base_link) + "\n\n";
  }
  text += joints == 0 ? "default_joint_positions: {}\n" : "default_joint_positions:\n";
  for (std::size_t joint = 0; joint < joints; ++joint) {
    text += "  " + yaml_text(context.joint_names[joint]) + ": " + decimal(at[joint]) + "\n";
  }
  text += "\ncspace:\n  joint_names: " + names(context.joint_names) +
          "\n  acceleration_limits: " + same(kAcceleration, joints) +
          "\n  jerk_limits: " + same(kJerk, joints) + "\n\ntool_frames: " +
          (context.tool_link.empty() ? std::string("[]") : names({context.tool_link})) +
          "\n\ncollision:\n  geometry: collision_spheres\n  buffer_distance:";
  std::map<std::string, double> distances = spheres.collision_buffers;
  if (distances.empty() && spheres.collision_buffer != 0.0) {
    for (const LinkSpheres& link : spheres.links) distances[link.link] = spheres.collision_buffer;
  }
  text += buffers(distances, "    ") + "\nself_collision:\n  geometry: collision_spheres\n" +
          "  buffer_distance:" + buffers(spheres.self_collision_buffer, "    ") +
          "  ignore:" + ignored(spheres, "    ") +
          "\ngeometry:\n  collision_spheres:\n    spheres:\n" + yaml_spheres(spheres, 6);
  return text;
}

}  // namespace spherule::internal
