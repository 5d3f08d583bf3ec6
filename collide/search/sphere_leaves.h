// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/nearest_first.h"
#include "collide/search/relative_pose.h"
#include "collide/search/tree_pair.h"

namespace spherule::internal {

// Leaf test of two sphere trees.
class SphereLeaves {
 public:
  SphereLeaves(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
               double clearance = 0.0)
      : a_(a), b_(b), pose_(pose), clearance_(clearance) {}

  bool touches(NodePair pair) const {
    return pose_.touches(sphere_a(pair), sphere_b(pair), clearance_);
  }
  double gap(NodePair pair) const { return pose_.gap(sphere_a(pair), sphere_b(pair)); }
  GapInterval interval(NodePair pair) const { return {gap(pair), gap(pair)}; }

 private:
  Sphere sphere_a(NodePair pair) const { return a_.sphere(pair.index(0)); }
  Sphere sphere_b(NodePair pair) const { return b_.sphere(pair.index(1)); }

  const SphereTree& a_;
  const SphereTree& b_;
  const RelativePose& pose_;
  const double clearance_;
};

}  // namespace spherule::internal
