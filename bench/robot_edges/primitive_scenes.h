// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/primitive.h"
#include "spheretree/pose.h"

#include <string>
#include <vector>

namespace spherule {

struct PlacedPrimitive {
  std::string name;
  Primitive primitive;
  Pose world_from_primitive;
};

struct PrimitiveScene {
  std::string name;
  std::vector<PlacedPrimitive> obstacles;
};

// Seven scenes around an arm that stands at the origin and reaches 0.85 m, the like of those that
// planners are compared in. The same each time.
std::vector<PrimitiveScene> primitive_scenes();

}  // namespace spherule
