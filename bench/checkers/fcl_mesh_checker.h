// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>
#include <string>
#include <vector>

namespace spherule {

// FCL on the triangle meshes. A fair setting: hierarchies of oriented boxes (FCL copies and moves a
// whole model for each query with its other volumes), contacts off, one contact enough, a fresh
// result for every pair. What differs:
struct FclMeshSetting {
  enum class Volume { kObb, kObbRss };
  enum class Precision { kDouble, kFloat };  // Debian's library; instantiated here, with our flags
  // What stands in front of a mesh pair: our test of the bodies' exact axis-parallel boxes, or
  // FCL's DynamicAABBTreeCollisionManager over the obstacles.
  enum class Front { kBoxes, kManager };

  Volume volume = Volume::kObbRss;
  Precision precision = Precision::kDouble;
  Front front = Front::kBoxes;
};

std::string to_string(const FclMeshSetting& setting);
std::vector<FclMeshSetting> all_fcl_mesh_settings();
std::unique_ptr<Checker> make_fcl_mesh_checker(const Workload& workload,
                                               const FclMeshSetting& setting);

}  // namespace spherule
