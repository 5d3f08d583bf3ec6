// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What is measured beside the workload: how the cost of a check grows with the number of spheres,
// what it is among few obstacles, and how it depends on the distance of two bodies.

#include "bench/checkers/workload.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace spherule {

struct StudyOptions {
  int rounds = 5;          // alternating
  std::size_t stride = 1;  // of the program
};

// The workload with more spheres over the same meshes (refined_cover.h). Times are of a check.
struct SizeRow {
  std::size_t factor = 1;      // requested
  std::size_t spheres = 0;     // all parts together
  double single_ns = 0.0;      // one configuration a call, in path order
  double shuffled_ns = 0.0;    // the same in a random order
  double batch_ns = 0.0;       // in batches, in path order
  double free_ns = 0.0;        // as single_ns, of the configurations that are free in every size
  double node_tests = 0.0;     // of collide() for each pair of trees up to the first contact
  std::size_t collisions = 0;  // in the whole program
  std::size_t missed = 0;      // the oracle says collision
};

std::vector<SizeRow> study_sizes(const Workload& workload,
                                 const std::vector<std::uint32_t>& touching_bodies,
                                 const StudyOptions& options);

// The robot among few single spheres.
struct SmallRow {
  std::size_t robot_spheres = 0;
  std::size_t obstacles = 0;
  std::string order;  // "path": the program; "random": positions anywhere within the limits
  double collision_percent = 0.0;
  double single_ns = 0.0;
  double batch_ns = 0.0;
  double collides_ns = 0.0;    // forward_kinematics() and collides() for each body
  double kinematics_ns = 0.0;  // of these, the first alone
  double flat_scan_ns = 0.0;   // with kinematics of its own
  std::size_t missed = 0;      // by the flat scan, where collides() finds a contact
  std::size_t extra = 0;       // by its rounding
};

std::vector<SmallRow> study_small_environments(const Workload& workload,
                                               const StudyOptions& options);

// Two bodies at a distance, for instance torch and workpiece. Medians over random poses.
struct DistanceRow {
  double relative =
      0.0;  // distance / size; size: the mean of the diameters of the spheres around them
  double distance_m = 0.0;
  // Booleans. FCL at a distance of the meshes, the fastest of its settings, alone and behind our
  // test of exact boxes; ours at that distance of the sphere sets, then in FCL's poses, where the
  // sphere sets are nearer or overlap, then there with contacts confirmed on the triangles.
  double fcl_collide_ns = 0.0;
  std::string fcl_collide_setting;
  double fcl_boxed_collide_ns = 0.0;
  std::string fcl_boxed_collide_setting;
  double collides_ns = 0.0;
  double collides_same_poses_ns = 0.0;
  double confirmed_ns = 0.0;
  double overlap_percent = 0.0;  // of FCL's poses: the sphere sets do
  double node_tests = 0.0;       // of collide() at the distance of the sphere sets
  // Distances, likewise.
  double fcl_distance_ns = 0.0;
  std::string fcl_distance_setting;
  double distance_ns = 0.0;
  double distance_node_tests = 0.0;
};

std::vector<DistanceRow> study_distances(const Part& moving, const Part& standing,
                                         const StudyOptions& options);

// All three, the last of torch and workpiece: prints their tables and returns what stands under
// "studies" in results.json. Throws Error if spheres missed a collision.
nlohmann::ordered_json run_studies(const Workload& workload,
                                   const std::vector<std::uint32_t>& touching_bodies,
                                   const StudyOptions& options);

// A configuration of the first weld, for pictures.
inline constexpr std::size_t kShownConfiguration = 300;

// Parts in their places, in the world's frame, as meshes and as spheres.
struct PlacedParts {
  TriangleMesh mesh;
  std::vector<Sphere> spheres;
};

// The cell in one configuration: robot, torch, workpiece and table, by these names.
std::map<std::string, PlacedParts> place_cell(const Workload& workload,
                                              const ArmPositions& configuration);

// The same for `spherule view`: FOLDER/PART.stl and FOLDER/PART.spheres.json. Throws Error.
void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder);

// The same cell with the published visual meshes of the ABB IRB 4400L and a real torch, from a
// folder that holds robots/abb_irb4400l and torch/torch.stl. Throws Error if they are not there.
Workload make_real_cell(const std::filesystem::path& models);

}  // namespace spherule
