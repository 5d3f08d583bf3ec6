// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/internal/relative_pose.h"
#include "collide/internal/triangle_pair.h"
#include "collide/mesh_contact.h"

namespace spherule::internal {

// Two placed meshes: contact of the triangles under two of their spheres, and containment. Refers
// to its arguments. Swapping the meshes changes no answer.
//
// Frames. Corners are compared in the world's axes about the point half way between the origins of
// the two frames: x = Ra x' + d / 2 and y = Rb y' - d / 2, so that X - Y is the offset of
// relative_pose.h. The products err by 65.2 u |x'| and 65.2 u |y'|, the rounding of d by u |d|, the
// two sums by u (|x'| + |y'| + |d|): 66.2 u (|x'| + |y'|) + 2 u |d| < 68 u S. Every corner lies in
// a ball of its cover, so that |x'| + |y'| + |d| <= S. That is what triangle_contact() asks for,
// with pad = leaf_pad().
//
// Filters. Images of centres and points in the other mesh's frame err by less than 136 u S; a
// common point of two triangles lies in both balls, so a triangle that is farther from the other
// ball's image than its radius and 144 u S is not concerned. Rounding of the sums is in the rest.
class ListedTriangles {
 public:
  ListedTriangles(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                  const Pose& world_from_b, const RelativePose& pose);

  // False only if no triangle under the one sphere has a point in common, within both balls, with
  // a triangle under the other.
  bool touch(std::int32_t sphere_a, std::int32_t sphere_b) const;

  // False only if no component of one mesh lies inside the other; the surfaces must not touch.
  bool contained() const;

 private:
  static constexpr std::size_t kBlock = 32;
  struct Block {
    std::array<Triangle, kBlock> triangles;
    std::size_t count = 0;
  };
  // One of the two meshes, with the way to the frame of the corners.
  struct Side {
    const CoveredMesh& mesh;
    const Eigen::Matrix3d& rotation;
    Eigen::Vector3d shift;
    FrameChange from_other;

    Triangle placed(const Triangle& triangle) const;
    Eigen::Vector3d image_of(const Eigen::Vector3d& point_of_other) const;
  };

  // Fills `block` with those of the `listed` that come near the ball, in the side's frame, from
  // `next` on, which it moves on.
  void collect(const Side& side, std::span<const std::int32_t> listed, const Sphere& ball,
               std::size_t& next, Block& block) const;
  bool touch(const Block& a, const Block& b) const;
  bool holds_a_component(const Side& side, const CoveredMesh& other) const;

  Side a_;
  Side b_;
  double scene_size_;
  double corner_pad_;
  double image_pad_;
};

}  // namespace spherule::internal
