// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What checks of mechanisms are made from: whether it can be, and as the kernels have it.

#include "collide/mechanism/coherence_cache.h"
#include "collide/mechanism/mechanism_check.h"
#include "collide/mechanism/mechanism_kernel.h"
#include "collide/search/packed_tree.h"
#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace spherule::internal {

// Each throws Error, where an index is out of range, something is missing or a number cannot be
// used.
void check_frames(std::span<const MechanismFrame> frames);
void check_body(std::size_t body, int frame, std::size_t frame_count, bool has_shape);
void check_obstacles(std::span<const MechanismObstacle> obstacles);
void check_pairs(std::span<const MechanismPair> pairs, std::size_t bodies, std::size_t obstacles);
void check_pose_error(double pose_error);

KernelFrame kernel_frame(const MechanismFrame& frame);

// How many variables the frames name: one more than the largest index.
int variable_count(std::span<const MechanismFrame> frames);

// From the root to a frame: the largest distance of its origin, and how many frames it takes.
struct Chain {
  double length = 0.0;
  double frames = 0.0;
};

// Of every frame; throws Error for one of more than kLongestLaneChain frames.
std::vector<Chain> chains_of(std::span<const MechanismFrame> frames);

// Throws Error for instructions that this machine has not got.
const Kernels& kernels_for(InstructionSet instructions);

// Where a sphere of a joined set comes from.
struct SphereOrigin {
  int part = 0;  // a body or an obstacle
  std::int32_t sphere = 0;
};

// The spheres of bodies on one frame, in that frame, or of obstacles, in the root's.
struct JoinedSpheres {
  int frame = -1;
  std::vector<Sphere> spheres{};
  std::vector<SphereOrigin> origins{};
};

// Bodies and obstacles that are searched together: obstacles that meet the same bodies, and bodies
// on one frame that meet the same obstacles. Only those that are in a pair are here, and the pairs
// stand in the order in which they, or what they are joined with, are first named.
struct JoinedScene {
  std::vector<JoinedSpheres> bodies;
  std::vector<JoinedSpheres> obstacles;
  std::vector<KernelPair> pairs;

  JoinedScene(std::span<const MechanismBody> all_bodies,
              std::span<const MechanismObstacle> all_obstacles,
              std::span<const MechanismPair> all_pairs);
};

}  // namespace spherule::internal

// What a MechanismCheck and its scratch consist of.

namespace spherule {

// The kernel's problem, with what it points to.
struct MechanismCheck::Parts {
  explicit Parts(internal::JoinedScene joined) : scene(std::move(joined)) {}

  internal::JoinedScene scene;
  std::vector<internal::KernelFrame> frames{};
  std::vector<internal::KernelLaneFrame> lane_frames{};
  std::vector<internal::PackedTree> trees{};
  std::vector<internal::KernelBody> bodies{};
  std::vector<internal::KernelObstacle> obstacles{};
  internal::KernelProblem problem{};
  // Of the bodies: no point is further from the root; a bound of their frames' errors in direction,
  // and, times the reach, in position.
  std::vector<double> reach{};
  std::vector<double> tilt{};
  const internal::Kernels* kernels = nullptr;
  std::int64_t task_count = 1;
};

struct MechanismCheck::Scratch::Memory {
  std::shared_ptr<const Parts> owner;  // kept, so that no later check is at its address
  std::vector<double> middle;          // of a motion
  std::vector<double> sines;
  std::vector<double> cosines;
  std::vector<internal::KernelPose> poses;
  std::vector<internal::KernelTask> roots;
  std::vector<internal::KernelTask> tasks;
  std::vector<internal::KernelLaneVariable> lane_variables;
  std::vector<internal::KernelLanePose> lane_poses;
  std::vector<internal::KernelQueue> queues;
  std::vector<internal::KernelSpheres> placed;
  std::vector<std::uint64_t> generations;
  std::uint64_t generation = 0;
  std::vector<internal::KernelMemory> memories;
  internal::KernelScratch view = {};
  std::optional<internal::CoherenceCache> motion;
};

// Reports the spheres of joined sets as the caller knows them.
struct MechanismCheck::Translator {
  const internal::JoinedScene& scene;
  ConfirmFunction confirm_function;
  void* context;

  static bool confirm(void* translator, std::int32_t lane, internal::KernelPair pair,
                      std::int32_t body_sphere, std::int32_t obstacle_sphere) {
    const Translator& in = *static_cast<const Translator*>(translator);
    const internal::SphereOrigin& body = in.scene.bodies[static_cast<std::size_t>(pair.body)]
                                             .origins[static_cast<std::size_t>(body_sphere)];
    const internal::SphereOrigin& obstacle =
        in.scene.obstacles[static_cast<std::size_t>(pair.obstacle)]
            .origins[static_cast<std::size_t>(obstacle_sphere)];
    return in.confirm_function(in.context, lane,
                               {{body.part, obstacle.part}, body.sphere, obstacle.sphere});
  }
};

}  // namespace spherule
