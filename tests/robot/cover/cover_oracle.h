// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "robot/model/robot_model.h"
#include "tests/support/random.h"

#include <Eigen/Core>

#include <string>
#include <vector>

// What tests of link meshes and covers hold against: exact shapes, in numbers wide enough that
// their rounding does not matter, from definitions of their own.
namespace spherule::test {

using Wide = long double;
using WidePoint = Eigen::Matrix<Wide, 3, 1>;

// The motion that the pose stands for, and back.
WidePoint move(const Pose& pose, const WidePoint& point);
WidePoint unmove(const Pose& pose, const WidePoint& point);

// Any primitive but a half-space, some 2 `size` across at most, and a pose that moves it about as
// far.
Primitive random_primitive(Random& random, double size);
Pose random_pose(Random& random, double size);

// A point of the solid primitive: mostly on its surface, often on an edge, a corner or a pole.
WidePoint point_of(const Primitive& primitive, Random& random);
// How far outside of the primitive a point lies, 0 within; of a half-space not known.
Wide distance_to(const Primitive& primitive, const WidePoint& point);

// A robot of a chain of `links` links with one or two primitives each as collision shapes; every
// third link from the second on has none.
RobotDescription random_robot(Random& random, int links);

}  // namespace spherule::test
