// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What the templates of collide.h rest on, for either precision of FCL.
//
// @code{.cpp}
// #include <spherule/adapters/fcl/part_query.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// const spherule::fcl_api::CoveredPart part{.spheres = sphere};
// const spherule::Pose beside = spherule::Pose::from_translation({0.15, 0, 0});
// assert(spherule::fcl_api::internal::contacts({part, {}}, {part, beside}, 1, false).size() == 1);
// @endcode

#include "adapters/fcl/sphere_model.h"
#include "collide/collide.h"
#include "geometry/pose.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::fcl_api::internal {

inline constexpr std::intptr_t kNone = -1;

struct PlacedPart {
  const CoveredPart& part;
  Pose world_from_part;
};

// In double.
struct PartContact {
  // Two triangles that touch, or two spheres where no triangles are queried; kNone for a body that
  // lies inside the other without touching its triangles.
  std::intptr_t b1 = kNone;
  std::intptr_t b2 = kNone;
  // Only if details are requested.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double depth = 0.0;
};

struct PartDistance {
  DistanceResult bounds;
  Eigen::Vector3d points[2];  // of the two spheres that are nearest, nearest to each other
};

// None exactly if the parts are free of each other; otherwise at least one and at most `most` (at
// least 1), of different pairs.
std::vector<PartContact> contacts(const PlacedPart& a, const PlacedPart& b, std::size_t most,
                                  bool details);

PartDistance distance(const PlacedPart& a, const PlacedPart& b, double tolerance);

}  // namespace spherule::fcl_api::internal
