// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a MechanismCheck and its scratch consist of.

#include "collide/mechanism/coherence_cache.h"
#include "collide/mechanism/joined_scene.h"
#include "collide/mechanism/mechanism_kernel.h"
#include "collide/mechanism_check.h"
#include "collide/search/packed_tree.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

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
