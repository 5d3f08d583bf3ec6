// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_targets.h"

#include "base/error.h"
#include "base/files.h"
#include "geometry/triangle_mesh.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "io/sphere_text.h"
#include "robot/files/robot_description.h"
#include "robot/files/scene_file.h"
#include "robot/files/trajectory_file.h"
#include "robot/formats/sphere_formats.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/proof_scope.h"
#include "simplifier/types/zones.h"
#include "spheretree/tree_file.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/support/exact/trees.h"

#include <algorithm>
#include <array>
#include <cmath>
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

namespace {

namespace fs = std::filesystem;

void expect(bool sound, const char* what) {
  if (!sound) throw std::logic_error(what);
}

void read_as_mesh(const fs::path& file) {
  const TriangleMesh mesh = read_mesh(file);
  const auto is_valid = unless_refused([&] {
    validate(mesh, "mesh");
    return true;
  });
  expect(is_valid.has_value(), "the mesh is not valid");
  if (mesh.triangles.size() <= 2000) describe(mesh_report(mesh));
  stated_unit(file);
}

void read_as_spheres(const fs::path& file) {
  const SphereFile read = load_spheres(file);
  expect(std::ranges::all_of(read.spheres, [](const Sphere& s) { return is_usable(s); }),
         "a sphere is not usable");
  // What was read can be written and read again.
  const std::string text = internal::encode_spheres(read, "again");
  expect(internal::encode_spheres(internal::decode_spheres(text, "again"), "again") == text,
         "what is written is read otherwise");
}

void read_as_tree(const fs::path& file) {
  const std::string fault = fault_of(load_tree(file).data());
  expect(fault.empty(), fault.c_str());
}

void read_as_zones(const fs::path& file) {
  for (const Zone& zone : parse_zones(read_file(file), file.string())) {
    expect(!zone.max_error || *zone.max_error > 0.0, "an error is not positive");
  }
}

void read_as_points(const fs::path& file) {
  const PointCloudFile cloud = read_point_cloud(file);
  expect(!cloud.points.empty() && cloud.points.front().allFinite(), "points are not finite");
}

void read_as_urdf(const fs::path& file) {
  const RobotDescription robot =
      read_urdf(file, {.require_visual_meshes = false, .require_collision_meshes = false});
  expect(robot.links.size() == robot.model.links().size(), "links differ");
  for (const Joint& joint : robot.model.joints()) {
    expect(joint.axis.allFinite() && joint.lower <= joint.upper, "a joint is not sound");
  }
}

void read_as_trajectory(const fs::path& file) {
  RobotModel robot("base");
  robot.add_link("slide", "base", {.name = "slider", .type = JointType::kPrismatic});
  robot.add_link("arm", "slide", {.name = "turn", .type = JointType::kRevolute});
  for (const AngleUnit unit : {AngleUnit::kRadians, AngleUnit::kDegrees}) {
    const Trajectory trajectory = read_trajectory(file, robot, unit);
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      for (const double q : trajectory.configuration(i)) expect(std::isfinite(q), "not finite");
    }
  }
}

void read_as_pairs(const fs::path& file) {
  internal::decode_link_pairs(read_file(file), file.string());
}

void read_as_robot_spheres(const fs::path& file) {
  const SphereFormatFile read = [&] {
    try {
      return read_robot_spheres(file);
    } catch (const Error&) {  // a format of one mesh
      return read_robot_spheres(file, {.link = "arm"});
    }
  }();
  for (const LinkSpheres& link : read.spheres.links) {
    for (const Sphere& sphere : link.spheres) expect(is_usable(sphere), "a sphere is not usable");
  }
}

constexpr const char* kXml = "xml.dict";
constexpr const char* kJson = "json.dict";
constexpr const char* kYaml = "yaml.dict";

const FuzzTarget kTargets[] = {
    {"stl", ".stl", read_as_mesh, ""},
    {"obj", ".obj", read_as_mesh, ""},
    {"ply", ".ply", read_as_mesh, ""},
    {"off", ".off", read_as_mesh, ""},
    {"3mf", ".3mf", read_as_mesh, ""},
    {"3mf_model", ".3mf", read_as_mesh, kXml, threemf_around},
    {"dae", ".dae", read_as_mesh, kXml},
    {"gltf", ".gltf", read_as_mesh, kJson},
    {"glb", ".glb", read_as_mesh, kJson},
    {"spheres", ".json", read_as_spheres, kJson},
    {"tree", ".tree", read_as_tree, ""},
    {"tree_content", ".tree", read_as_tree, "", with_checksum},
    {"zones", ".json", read_as_zones, kJson},
    {"scene", ".json", [](const fs::path& file) { read_scene(file); }, kJson},
    {"trajectory", ".csv", read_as_trajectory, ""},
    {"points", ".xyz", read_as_points, ""},
    {"points_ply", ".ply", read_as_points, ""},
    {"points_pcd", ".pcd", read_as_points, ""},
    {"urdf", ".urdf", read_as_urdf, kXml},
    {"srdf", ".srdf", [](const fs::path& file) { read_srdf(file); }, kXml},
    {"pairs", ".pairs", read_as_pairs, ""},
    {"pairs_content", ".pairs", read_as_pairs, "", with_checksum},
    {"spheres_xml", ".urdf", read_as_robot_spheres, kXml},
    {"spheres_yaml", ".yml", read_as_robot_spheres, kYaml},
    {"spheres_json", ".json", read_as_robot_spheres, kJson},
    {"spheres_sph", ".sph", read_as_robot_spheres, ""},
    {"into_yaml", ".yml", write_into_yaml, kYaml},
    {"into_srdf", ".srdf", write_into_srdf, kXml},
    {"into_urdf", ".urdf", write_into_urdf, kXml},
};

}  // namespace

std::span<const FuzzTarget> fuzz_targets() {
  return kTargets;
}

const FuzzTarget& fuzz_target(std::string_view name) {
  const auto found = std::ranges::find(kTargets, name, &FuzzTarget::name);
  if (found == std::end(kTargets)) throw std::out_of_range("no target " + std::string(name));
  return *found;
}

}  // namespace spherule::test
