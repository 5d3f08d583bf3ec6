// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_description.h"
#include "spheretree/sphere.h"

#include <span>

namespace spherule::internal {

// Whether every shape is a primitive that lies in a single one of the spheres, in exact arithmetic,
// and the spheres that hold them enclose no cavity: then these cover the shapes and their inside
// (G1), without any tessellation. False may also mean that this is not proved: it is not where a
// shape is a mesh, nor where one of the spheres that hold them overlaps more than two others of
// these. The spheres are usable.
bool lie_in_single_spheres(std::span<const LinkShape> shapes, std::span<const Sphere> spheres);

}  // namespace spherule::internal
