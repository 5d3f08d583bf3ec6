// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/solids/primitive.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "robot/model/robot_model.h"

#include <span>
#include <string>

namespace spherule::internal {

// A closed mesh about a solid primitive, seen counter-clockwise from outside. In exact arithmetic
// it encloses every point of the primitive and lies within `chord_error` of it; the mesh's
// vertex_error bounds what rounding moved. A box comes out exactly.
//
// A curved primitive is a polygon, tangent to its outline, that is turned about z: rings of equal
// regular polygons whose sides touch the outline's circles. The directions come from halving
// angles by square roots, so that they are the same on every machine.
//
// Throws Error, naming `subject`, for a half-space, sizes that require_primitive() refuses, a
// chord error that is not positive, and one that requires more than 1024 sides.
TriangleMesh mesh_around(const Primitive& primitive, double chord_error,
                         const std::string& subject);

// Whether every shape is a primitive that lies in a single one of the spheres, in exact arithmetic,
// and the spheres that hold them enclose no cavity: then these cover the shapes and their inside
// (G1), without any tessellation. False may also mean that this is not proved: it is not where a
// shape is a mesh, nor where one of the spheres that hold them overlaps more than two others of
// these. The spheres are usable.
bool lie_in_single_spheres(std::span<const LinkShape> shapes, std::span<const Sphere> spheres);

}  // namespace spherule::internal
