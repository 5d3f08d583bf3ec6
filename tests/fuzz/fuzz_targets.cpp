// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/fuzz_targets.h"

#include "base/error.h"
#include "base/files.h"
#include "geometry/mesh_report.h"
#include "io/length_unit.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "robot/files/point_cloud_file.h"
#include "robot/files/scene_file.h"
#include "robot/files/srdf.h"
#include "robot/files/trajectory_file.h"
#include "robot/files/urdf.h"
#include "robot/formats/sphere_formats.h"
#include "robot/pairs/link_pairs.h"
#include "simplifier/zone_file.h"
#include "spheretree/check.h"
#include "spheretree/tree_file.h"
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/fuzz/kept_file_targets.h"
#include "tests/fuzz/sealed_content.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

void expect(bool sound, const char* what) {
  if (!sound) throw std::logic_error(what);
}

void read_as_mesh(const fs::path& file) {
  const TriangleMesh mesh = read_mesh(file);
  validate(mesh, "what was read");
  if (mesh.triangles.size() <= 2000) describe(mesh_report(mesh));
  stated_unit(file);
}

void read_as_spheres(const fs::path& file) {
  const SphereFile read = load_spheres(file);
  expect(std::ranges::all_of(read.spheres, [](const Sphere& s) { return is_usable(s); }),
         "a sphere is not usable");
}

void read_as_tree(const fs::path& file) {
  expect(check(load_tree(file)).valid, "a sphere does not enclose its children");
}

void read_as_zones(const fs::path& file) {
  for (const Zone& zone : parse_zones(read_file(file), file.string())) {
    expect(!zone.max_error || *zone.max_error > 0.0, "an error is not positive");
  }
}

void read_as_scene(const fs::path& file) {
  read_scene(file);
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

void read_as_srdf(const fs::path& file) {
  read_srdf(file);
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
    {"stl", ".stl", read_as_mesh, stl_seeds, ""},
    {"obj", ".obj", read_as_mesh, obj_seeds, ""},
    {"ply", ".ply", read_as_mesh, ply_seeds, ""},
    {"off", ".off", read_as_mesh, off_seeds, ""},
    {"3mf", ".3mf", read_as_mesh, threemf_seeds, ""},
    {"3mf_model", ".3mf", read_as_mesh, threemf_model_seeds, kXml, threemf_around},
    {"dae", ".dae", read_as_mesh, dae_seeds, kXml},
    {"gltf", ".gltf", read_as_mesh, gltf_seeds, kJson},
    {"glb", ".glb", read_as_mesh, glb_seeds, kJson},
    {"spheres", ".json", read_as_spheres, sphere_file_seeds, kJson},
    {"tree", ".tree", read_as_tree, tree_seeds, ""},
    {"tree_content", ".tree", read_as_tree, tree_content_seeds, "", with_checksum},
    {"zones", ".json", read_as_zones, zone_seeds, kJson},
    {"scene", ".json", read_as_scene, scene_seeds, kJson},
    {"trajectory", ".csv", read_as_trajectory, trajectory_seeds, ""},
    {"points", ".xyz", read_as_points, point_seeds, ""},
    {"points_ply", ".ply", read_as_points, ply_seeds, ""},
    {"urdf", ".urdf", read_as_urdf, urdf_seeds, kXml},
    {"srdf", ".srdf", read_as_srdf, srdf_seeds, kXml},
    {"pairs", ".pairs", read_as_pairs, pair_seeds, ""},
    {"pairs_content", ".pairs", read_as_pairs, pair_content_seeds, "", with_checksum},
    {"spheres_xml", ".urdf", read_as_robot_spheres, sphere_xml_seeds, kXml},
    {"spheres_yaml", ".yml", read_as_robot_spheres, sphere_yaml_seeds, kYaml},
    {"spheres_json", ".json", read_as_robot_spheres, sphere_json_seeds, kJson},
    {"spheres_sph", ".sph", read_as_robot_spheres, bradshaw_seeds, ""},
    {"into_yaml", ".yml", write_into_yaml, into_yaml_seeds, kYaml},
    {"into_srdf", ".srdf", write_into_srdf, into_srdf_seeds, kXml},
    {"into_urdf", ".urdf", write_into_urdf, into_urdf_seeds, kXml},
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
