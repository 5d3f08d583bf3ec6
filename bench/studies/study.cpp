// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/study.h"

#include "base/error.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "robot/model/kinematics.h"
#include "tests/support/solids.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace spherule {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SizeRow, factor, spheres, single_ns, shuffled_ns, batch_ns,
                                   free_ns, node_tests, collisions, missed)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SmallRow, obstacles, robot_spheres, order, collision_percent,
                                   single_ns, batch_ns, collides_ns, kinematics_ns, flat_scan_ns,
                                   missed, extra)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DistanceRow, relative, distance_m, fcl_collide_ns,
                                   fcl_collide_setting, fcl_boxed_collide_ns,
                                   fcl_boxed_collide_setting, collides_ns, collides_same_poses_ns,
                                   confirmed_ns, overlap_percent, node_tests, fcl_distance_ns,
                                   fcl_distance_setting, distance_ns, distance_node_tests)

namespace {

using Json = nlohmann::ordered_json;

void print_sizes(const std::vector<SizeRow>& rows) {
  if (rows.empty()) return;
  std::printf("\nmore spheres over the same meshes (x: times the first row)\n");
  std::printf("%9s %10s %6s %10s %6s %10s %6s %10s %6s %11s %8s %7s\n", "spheres", "single ns", "x",
              "shuffled", "x", "batch", "x", "free ones", "x", "node tests", "hits", "missed");
  const SizeRow& first = rows.front();
  for (const SizeRow& row : rows) {
    std::printf("%9zu %10.1f %6.2f %10.1f %6.2f %10.1f %6.2f %10.1f %6.2f %11.1f %8zu %7zu\n",
                row.spheres, row.single_ns, row.single_ns / first.single_ns, row.shuffled_ns,
                row.shuffled_ns / first.shuffled_ns, row.batch_ns, row.batch_ns / first.batch_ns,
                row.free_ns, row.free_ns / first.free_ns, row.node_tests, row.collisions,
                row.missed);
  }
}

void print_small(const std::vector<SmallRow>& rows) {
  if (rows.empty()) return;
  std::printf("\nthe robot among few spheres, ns a check (x: times as fast as the flat scan)\n");
  std::printf("%9s %7s %7s %7s %9s %6s %9s %6s %9s %6s %10s %10s %7s %6s\n", "obstacles", "robot",
              "order", "hit %", "single", "x", "batch", "x", "collides", "x", "kinematics",
              "flat scan", "missed", "extra");
  for (const SmallRow& row : rows) {
    std::printf(
        "%9zu %7zu %7s %7.1f %9.1f %6.2f %9.1f %6.2f %9.1f %6.2f %10.1f %10.1f %7zu "
        "%6zu\n",
        row.obstacles, row.robot_spheres, row.order.c_str(), row.collision_percent, row.single_ns,
        row.flat_scan_ns / row.single_ns, row.batch_ns, row.flat_scan_ns / row.batch_ns,
        row.collides_ns, row.flat_scan_ns / row.collides_ns, row.kinematics_ns, row.flat_scan_ns,
        row.missed, row.extra);
  }
}

void print_distances(const std::vector<DistanceRow>& rows) {
  if (rows.empty()) return;
  std::printf(
      "\ntorch and workpiece at a distance, median ns (x: times as fast as FCL's meshes)\n");
  std::printf("%7s %8s | %9s %-13s %9s %-13s | %9s %7s %7s | %9s %9s %7s %7s\n", "d/size", "d mm",
              "fcl", "(setting)", "boxed", "(setting)", "collides", "x fcl", "x boxed", "same pose",
              "confirmed", "overl.%", "tests");
  for (const DistanceRow& row : rows) {
    std::printf(
        "%7.3f %8.2f | %9.0f %-13s %9.0f %-13s | %9.0f %7.2f %7.2f | %9.0f %9.0f %7.0f %7.0f\n",
        row.relative, 1e3 * row.distance_m, row.fcl_collide_ns, row.fcl_collide_setting.c_str(),
        row.fcl_boxed_collide_ns, row.fcl_boxed_collide_setting.c_str(), row.collides_ns,
        row.fcl_collide_ns / row.collides_ns, row.fcl_boxed_collide_ns / row.collides_ns,
        row.collides_same_poses_ns, row.confirmed_ns, row.overlap_percent, row.node_tests);
  }
  std::printf("%7s %8s | %9s %-13s | %9s %7s %7s\n", "d/size", "d mm", "fcl dist.", "(setting)",
              "distance", "x", "tests");
  for (const DistanceRow& row : rows) {
    std::printf("%7.3f %8.2f | %9.0f %-13s | %9.0f %7.2f %7.0f\n", row.relative,
                1e3 * row.distance_m, row.fcl_distance_ns, row.fcl_distance_setting.c_str(),
                row.distance_ns, row.fcl_distance_ns / row.distance_ns, row.distance_node_tests);
  }
}

// What the oracle or collides() finds and another does not.
void check_nothing_missed(const Workload& workload, const std::vector<SizeRow>& sizes,
                          const std::vector<SmallRow>& small) {
  for (const SizeRow& row : sizes) {
    if (row.missed > 0) {
      throw Error(workload.name, std::to_string(row.spheres) + " spheres missed collisions");
    }
  }
  for (const SmallRow& row : small) {
    if (row.missed > 0) {
      throw Error(workload.name, std::to_string(row.obstacles) + " obstacles: collisions missed");
    }
  }
}

const Part& part_named(const std::string& name, const Workload& workload) {
  for (const Body& body : workload.bodies) {
    if (body.part.name == name) return body.part;
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    if (obstacle.part.name == name) return obstacle.part;
  }
  throw Error(workload.name, "has no part " + name);
}

}  // namespace

Json run_studies(const Workload& workload, const std::vector<std::uint32_t>& touching_bodies,
                 const StudyOptions& options) {
  const auto sizes = study_sizes(workload, touching_bodies, options);
  print_sizes(sizes);
  const auto small = study_small_environments(workload, options);
  print_small(small);
  const auto distances =
      study_distances(part_named("torch", workload), part_named("workpiece", workload), options);
  print_distances(distances);
  std::fflush(stdout);
  check_nothing_missed(workload, sizes, small);
  return {{"sizes", nlohmann::json(sizes)},
          {"small_environments", nlohmann::json(small)},
          {"distances", nlohmann::json(distances)}};
}

namespace {

void add(const Part& part, const Pose& pose, PlacedParts& group) {
  append(group.mesh, placed(part.mesh, pose.matrix(), pose.translation()));
  for (const Sphere& sphere : part.tree->spheres()) {
    group.spheres.push_back({pose * sphere.center, sphere.radius});
  }
}

}  // namespace

std::map<std::string, PlacedParts> place_cell(const Workload& workload,
                                              const ArmPositions& configuration) {
  std::vector<Pose> world_from_link;
  forward_kinematics(workload.robot, configuration, world_from_link);
  std::map<std::string, PlacedParts> groups;
  for (const Body& body : workload.bodies) {
    add(body.part, world_from_link[static_cast<std::size_t>(body.link)],
        groups[body.part.name == "torch" ? "torch" : "robot"]);
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    add(obstacle.part, obstacle.world_from_part, groups[obstacle.part.name]);
  }
  return groups;
}

void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, group] : place_cell(workload, configuration)) {
    write_stl(group.mesh, folder / (name + ".stl"));
    SphereFile file;
    file.spheres = group.spheres;
    save_spheres(file, folder / (name + ".spheres.json"));
  }
}

}  // namespace spherule
