// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

namespace spherule {

// Plain closed solids for tests and benchmarks, outward oriented, in whatever unit the arguments
// have. Unless said otherwise they are centred at the origin.

// 12 triangles.
TriangleMesh make_box(const Eigen::Vector3d& size);
TriangleMesh make_cube(double edge);

// Latitude and longitude; 2 slices (stacks - 1) triangles, inscribed in the sphere.
TriangleMesh make_sphere(double radius, int slices, int stacks);

// Inscribed in the torus about z; 2 around along triangles.
TriangleMesh make_torus(double ring_radius, double tube_radius, int along, int around);

// About z; 4 sides - 4 triangles.
TriangleMesh make_cylinder(double radius, double length, int sides);

// About z, apex up; 2 sides - 2 triangles.
TriangleMesh make_cone(double radius, double length, int sides);

// Hollow, open at both ends, about z; 8 sides triangles. `outer` and `inner` are diameters.
TriangleMesh make_pipe(double outer, double inner, double length, int sides);

// Two legs of the given length at a right angle, in the quadrant x, z > 0, centred in y.
TriangleMesh make_l_bracket(double leg, double width, double thickness);

// A plate in the xy plane, centred in z too, with holes_x by holes_y round holes on an even grid.
TriangleMesh make_plate_with_holes(const Eigen::Vector3d& size, int holes_x, int holes_y,
                                   double hole_diameter, int sides);

}  // namespace spherule
