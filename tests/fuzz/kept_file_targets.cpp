// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/kept_file_targets.h"

#include "base/error.h"
#include "base/files.h"
#include "robot/files/srdf.h"
#include "robot/files/urdf.h"
#include "tests/robot/formats/sphere_sets.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

// What the reader returns, or nothing where it refuses the file.
template <class Read>
auto unless_refused(Read read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error&) {
    return std::nullopt;
  }
}

// By name: a URDF keeps its own order.
std::vector<LinkSpheres> without_empty(std::vector<LinkSpheres> links) {
  std::erase_if(links, [](const LinkSpheres& link) { return link.spheres.empty(); });
  std::ranges::sort(links, {}, &LinkSpheres::link);
  return links;
}

void expect_spheres(const std::vector<LinkSpheres>& links) {
  const std::string fault =
      difference(without_empty(links), without_empty(spheres_to_keep().links));
  if (!fault.empty()) throw std::logic_error("other spheres were written: " + fault);
}

// Spheres of other links stay in YAML and in a URDF.
std::vector<LinkSpheres> of_links_to_keep(std::vector<LinkSpheres> links) {
  std::erase_if(links, [](const LinkSpheres& link) {
    return std::ranges::none_of(spheres_to_keep().links, [&](const LinkSpheres& written) {
      return written.link == link.link;
    });
  });
  return links;
}

// What is read of a file that was written; a refusal is no answer here.
template <class Read>
auto read_again(Read read) {
  try {
    return read();
  } catch (const Error& error) {
    throw std::logic_error(std::string("what was written cannot be read: ") + error.what());
  }
}

// Writes the spheres into the file. The place of the result, beside it.
fs::path written_into(const fs::path& file, SphereFormat format) {
  const auto write = [&](const fs::path& original, const char* name) {
    fs::path result = file.parent_path() / name;
    write_robot_spheres(spheres_to_keep(), format, {.original = original}, result);
    return result;
  };
  const fs::path kept = write(file, "kept");
  read_again([&] { return write(kept, "again"); });
  return kept;
}

// What an SRDF says beside pairs and spheres.
std::vector<std::string> rest_of(const SemanticDescription& semantics) {
  std::vector<std::string> rest = {semantics.robot_name};
  const auto put = [&](const auto& texts) { rest.insert(rest.end(), texts.begin(), texts.end()); };
  for (const JointGroup& group : semantics.groups) {
    rest.push_back("group " + group.name);
    put(group.links);
    put(group.joints);
    put(group.subgroups);
    for (const LinkChain& chain : group.chains) put(std::array{chain.base_link, chain.tip_link});
  }
  for (const GroupState& state : semantics.group_states) {
    put(std::array{"state " + state.name, state.group});
    for (const JointState& joint : state.joints) {
      rest.push_back(joint.joint);
      for (const double position : joint.position) rest.push_back(std::to_string(position));
    }
  }
  for (const EndEffector& tool : semantics.end_effectors) {
    put(std::array{"tool " + tool.name, tool.group, tool.parent_link, tool.parent_group});
  }
  return rest;
}

}  // namespace

const RobotSpheres& spheres_to_keep() {
  static const RobotSpheres kSpheres{
      .robot = "arm",
      .links = {{"base", {{{0, 0, 0}, 0.5}}}, {"arm", {{{1, -2, 3e-5}, 0.25}}}, {"hand", {}}},
      .self_collision_ignore = {
          {"base", "arm", "Adjacent"}, {"hand", "base", "Never"}, {"arm", "hand", {}}}};
  return kSpheres;
}

void write_into_yaml(const fs::path& file) {
  const auto before = unless_refused([&] { return read_robot_spheres(file); });
  bool is_written = false;
  for (const SphereFormat format : {SphereFormat::kCurobo, SphereFormat::kXrdf}) {
    const auto kept = unless_refused([&] { return written_into(file, format); });
    if (!kept) continue;
    is_written = true;
    if (!before || before->format != format) continue;
    const SphereFormatFile after = read_again([&] { return read_robot_spheres(*kept); });
    if (after.format != format) throw std::logic_error("another format was written");
    expect_spheres(of_links_to_keep(after.spheres.links));
  }
  if (!is_written) throw Error(file.string(), "takes no spheres");
}

void write_into_srdf(const fs::path& file) {
  const auto before = unless_refused([&] { return read_srdf(file); });
  const fs::path kept = written_into(file, SphereFormat::kSrdf);
  if (!before) return;
  const SemanticDescription after = read_again([&] { return read_srdf(kept); });
  expect_spheres(after.sphere_approximations);
  if (rest_of(after) != rest_of(*before))
    throw std::logic_error("groups, states or end effectors differ");
  for (const DisabledPair& pair : before->disabled_pairs) {
    const bool is_kept = std::ranges::any_of(after.disabled_pairs, [&](const DisabledPair& other) {
      return pair.link_a == other.link_a && pair.link_b == other.link_b &&
             pair.reason == other.reason;
    });
    if (!is_kept) throw std::logic_error("a pair is lost");
  }
}

void write_into_urdf(const fs::path& file) {
  const UrdfOptions any_mesh{.require_visual_meshes = false, .require_collision_meshes = false};
  const auto before = unless_refused([&] { return read_urdf(file, any_mesh); });
  const auto spheres_before = unless_refused([&] { return read_robot_spheres(file); });
  const fs::path kept = file.parent_path() / "kept";
  write_robot_spheres(spheres_to_keep(), SphereFormat::kUrdf, {.urdf = file}, kept);
  if (!before || !spheres_before) return;
  expect_spheres(
      of_links_to_keep(read_again([&] { return read_robot_spheres(kept); }).spheres.links));
  read_again([&] { return read_urdf(kept, any_mesh); });
}

}  // namespace spherule::test
