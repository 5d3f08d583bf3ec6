// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "robot/pairs/allowed_collisions.h"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace spherule {

// Another library's check of an arm's meshes in a scene, one configuration a call.
class ArmChecker {
 public:
  virtual ~ArmChecker() = default;
  virtual const char* name() const = 0;
  virtual bool collides(std::span<const double> configuration) = 0;
};

// What is tested: links with a mesh that a variable moves, against the scene; and pairs of links.
struct TestedLinks {
  std::vector<std::size_t> moving{};
  std::vector<std::pair<std::size_t, std::size_t>> pairs{};
};
TestedLinks tested_links(const Arm& arm, const AllowedCollisions& allowed);

}  // namespace spherule
