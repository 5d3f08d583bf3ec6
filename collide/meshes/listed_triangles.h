// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/patch_trees.h"
#include "collide/search/relative_pose.h"
#include "geometry/triangles.h"

#include <cstdint>
#include <optional>

namespace spherule::internal {

// Two placed meshes: contact of the triangles under two of their spheres, and containment. Refers
// to its arguments.
//
// Corners. They are compared in the world's axes about the point half way between the origins of
// the two frames: x = Ra x' + d / 2 and y = Rb y' - d / 2, so that X - Y is the offset of
// relative_pose.h. The products err by 65.2 u |x'| and 65.2 u |y'|, the rounding of d by u |d|, the
// two sums by u (|x'| + |y'| + |d|): 66.2 u (|x'| + |y'|) + 2 u |d| < 68 u S. Every corner lies in
// a sphere of its cover, so that |x'| + |y'| + |d| <= S. That is what triangle_contact() requires,
// with pad = leaf_pad().
//
// Images of points in the other mesh's frame err by less than 136 u S, and differences from the
// centre of a sphere there by 2 u S more; projections on an axis by 3 u S for the product and u S
// for their difference, in units of its length: kImagePad = 160 u S covers all.
//
// Boxes. They are compared in single precision, v = 2^-24, as seen from the centres of the two
// spheres, of radii r and r': a box's image has the centre R c + t, t being the difference of the
// two spheres' centres, and the half widths |R| h. Boxes enclose parts of spheres, so |c| and h are
// at most a little more than the radius. Let Z = r + r' + |t|_1. R and t rounded, three products
// and sums, the difference of the centres and the sum of the half widths err by less than 16 v Z a
// row. kBoxPad = 64 v Z; the absolute term covers underflow.
class ListedTriangles {
 public:
  ListedTriangles(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                  const Pose& world_from_b, const RelativePose& pose);

  // Two triangles that touch or, at least, are not proved to be apart: under spheres that were
  // requested, or, if there are none, none under these have a point in common within both spheres.
  std::optional<TrianglePair> touching(std::int32_t sphere_a, std::int32_t sphere_b) const;

  // As triangle_depth() says.
  double depth(const TrianglePair& pair) const;

  // False only if no component of one mesh lies inside the other; the surfaces must not touch.
  bool contained() const;

 private:
  static constexpr double kImagePad = 160.0 * kUnitRoundoff;
  static constexpr double kBoxPad = 0x1p-18;

  // One of the two meshes, with the ways to the frame of the corners and from the other mesh's.
  struct Side {
    // In the frame of the corners.
    Triangle placed(std::int32_t triangle) const;
    Sphere sphere(std::int32_t sphere) const {
      return mesh.cover().spheres()[static_cast<std::size_t>(sphere)];
    }

    const CoveredMesh& mesh;
    const PatchTrees& patches;
    const Eigen::Matrix3d& rotation;
    Eigen::Vector3d shift;
    FrameChange from_other;
  };

  class BoxSearch;
  bool holds_a_component(const Side& side, const CoveredMesh& other) const;

  Side sides_[2];
  double scene_size_;
  double corner_pad_;
  double image_pad_;
};

}  // namespace spherule::internal
