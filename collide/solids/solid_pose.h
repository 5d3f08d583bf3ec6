// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A sphere tree seen from a solid, in the terms of relative_pose.h: a is the tree, b the solid, and
// its reach the one of its field (solid_fields.h).
//
// A centre x has an image that errs by f <= 136 u |x| + 71 u |d|, and its norm is at most |x| + |d|
// up to that. The signed distance s is no steeper than 1 and errs by 8 u (|x| + |d| + reach) where
// the image stands: together by less than 144 u S.
//   - Canonical test, s <= r + pad + c (1 + 32 u) for a clearance c. Never missed: exactly
//     s <= r + c requires pad >= 144 u S and the rounding of the three terms of the limit, 1 u of
//     each of the first two and 3 u of c: kLeafPad = 152 u S. Little extra: s exceeds r + c by at
//     most (152 + 144 + 8) u S + 40 u c: kSlack = 304 u S.
//   - Node test: the sphere of a node contains those of its leaves, so that its s - r is no larger
//     than theirs. It must keep s - r <= c + 304 u S + 40 u c: a pad of 304 u T + 144 u T and the
//     same roundings, kNodePad = 464 u T, and c (1 + 64 u).
//   - Gap s - r: one rounding more, of terms that are at most T each: kGapError = 152 u T.
// Squares that underflow are below kUnderflow, as there.

#include "collide/search/relative_pose.h"
#include "collide/solids/solid_fields.h"

#include <cmath>

namespace spherule::internal {

template <class Field>
class SolidPose {
 public:
  SolidPose(const SphereTree& tree, const Pose& world_from_tree, const Field& field,
            const Pose& world_from_solid, double clearance = 0.0)
      : field_(field),
        pose_(tree, world_from_tree, field.reach(), world_from_solid),
        solid_from_tree_(pose_.b_from_a()),
        leaf_limit_((152.0 * kUnitRoundoff * pose_.scene_size() + kUnderflow) +
                    clearance * (1.0 + 32.0 * kUnitRoundoff)),
        node_limit_((464.0 * kUnitRoundoff * pose_.node_size() + 8.0 * kUnderflow) +
                    clearance * (1.0 + 64.0 * kUnitRoundoff)) {}

  double slack(double clearance) const {
    return 304.0 * kUnitRoundoff * pose_.scene_size() + 40.0 * kUnitRoundoff * clearance +
           4.0 * kUnderflow;
  }
  double gap_error() const { return 152.0 * kUnitRoundoff * pose_.node_size() + kUnderflow; }

  Eigen::Vector3d in_solid(const Eigen::Vector3d& p) const { return solid_from_tree_(p); }
  double signed_distance(const Sphere& sphere) const {
    return field_.signed_distance(in_solid(sphere.center));
  }
  // Of the sphere and the solid, within gap_error(); negative where they overlap.
  double gap(const Sphere& sphere) const { return signed_distance(sphere) - sphere.radius; }
  bool touches(const Sphere& sphere) const {
    return signed_distance(sphere) <= sphere.radius + leaf_limit_;
  }
  // True for all spheres that contain one that touches.
  bool may_touch(const Sphere& sphere) const {
    return signed_distance(sphere) <= sphere.radius + node_limit_;
  }

 private:
  const Field& field_;
  RelativePose pose_;
  FrameChange solid_from_tree_;
  double leaf_limit_;
  double node_limit_;
};

}  // namespace spherule::internal
