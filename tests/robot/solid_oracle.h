// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "tests/support/random.h"

#include <Eigen/Core>

namespace spherule::test {

// Exact shapes, in numbers wide enough that their rounding does not matter, from definitions of
// their own: nothing of it is shared with the library.
using Wide = long double;
using WidePoint = Eigen::Matrix<Wide, 3, 1>;

// The motion that the pose stands for, and back.
WidePoint move(const Pose& pose, const WidePoint& point);
WidePoint unmove(const Pose& pose, const WidePoint& point);

// Any primitive but a half-space, some 2 `size` across at most, and a pose that moves it about as
// far.
Primitive random_primitive(Random& random, double size);
Pose random_pose(Random& random, double size);

// A point of the solid primitive, but of no half-space: mostly on its surface, often on an edge, a
// corner or a pole.
WidePoint point_of(const Primitive& primitive, Random& random);
// How far outside of the primitive a point lies, 0 within.
Wide distance_to(const Primitive& primitive, const WidePoint& point);

// How far two primitives are from each other, by alternating projections. Not below the distance;
// above it by little, in these tests by less than 1e-4.
double distance_between(const Primitive& a, const Pose& world_from_a, const Primitive& b,
                        const Pose& world_from_b);

}  // namespace spherule::test
