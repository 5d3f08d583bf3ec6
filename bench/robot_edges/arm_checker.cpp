// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm_checker.h"

namespace spherule {

TestedLinks tested_links(const Arm& arm, const AllowedCollisions& allowed) {
  TestedLinks result;
  for (std::size_t i = arm.meshes.size(); i-- > 0;) {
    if (arm.meshes[i].triangles.empty()) continue;
    const int link = static_cast<int>(i);
    if (!allowed.allows(0, link) || allowed.reason(0, link) != AllowedReason::kRigid) {
      result.moving.push_back(i);
    }
    for (std::size_t k = i; k-- > 0;) {
      if (arm.meshes[k].triangles.empty() || allowed.allows(link, static_cast<int>(k))) continue;
      result.pairs.emplace_back(i, k);
    }
  }
  return result;
}

}  // namespace spherule
