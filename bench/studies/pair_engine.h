// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Two bodies as an engine knows them. Poses are handed over beforehand, so that changing them into
// the engine's own kind is not timed.
class PairEngine {
 public:
  virtual ~PairEngine() = default;
  // b stands still at the origin.
  virtual void set_poses(std::span<const Pose> world_from_a) = 0;
  virtual bool collides(std::size_t pose) = 0;
  // Of surfaces, or of sphere sets.
  virtual double distance(std::size_t pose) = 0;
};

struct NamedPairEngine {
  std::string name;
  std::unique_ptr<PairEngine> engine;
};

}  // namespace spherule
