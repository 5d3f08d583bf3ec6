// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/shapes.h"

#include "tests/support/solids.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace spherule {

using Eigen::Vector2d;
using Eigen::Vector3d;

TriangleMesh make_box(const Vector3d& size) {
  return extrude(rectangle(Vector2d::Zero(), size.head<2>()), {}, -0.5 * size.z(), 0.5 * size.z());
}

TriangleMesh make_cube(double edge) {
  return make_box(Vector3d::Constant(edge));
}

TriangleMesh make_sphere(double radius, int slices, int stacks) {
  Loop profile{{0.0, -radius}};
  for (int i = 1; i < stacks; ++i) {
    const double latitude = std::numbers::pi * (static_cast<double>(i) / stacks - 0.5);
    profile.emplace_back(radius * std::cos(latitude), radius * std::sin(latitude));
  }
  profile.emplace_back(0.0, radius);
  return revolve(profile, slices);
}

TriangleMesh make_torus(double ring_radius, double tube_radius, int along, int around) {
  return revolve(circle({ring_radius, 0.0}, tube_radius, around), along);
}

TriangleMesh make_cylinder(double radius, double length, int sides) {
  return extrude(circle(Vector2d::Zero(), radius, sides), {}, -0.5 * length, 0.5 * length);
}

TriangleMesh make_cone(double radius, double length, int sides) {
  TriangleMesh mesh;
  for (const Vector2d& p : circle(Vector2d::Zero(), radius, sides)) {
    mesh.vertices.emplace_back(p.x(), p.y(), -0.5 * length);
  }
  mesh.vertices.emplace_back(0.0, 0.0, 0.5 * length);
  for (int i = 0; i < sides; ++i) mesh.triangles.emplace_back(i, (i + 1) % sides, sides);
  for (int i = 2; i < sides; ++i) mesh.triangles.emplace_back(0, i, i - 1);
  return mesh;
}

TriangleMesh make_pipe(double outer, double inner, double length, int sides) {
  const double half = 0.5 * length;
  return revolve(
      {{0.5 * inner, -half}, {0.5 * outer, -half}, {0.5 * outer, half}, {0.5 * inner, half}},
      sides);
}

TriangleMesh make_l_bracket(double leg, double width, double thickness) {
  const Loop outline{{0.0, 0.0},       {leg, 0.0}, {leg, thickness}, {thickness, thickness},
                     {thickness, leg}, {0.0, leg}};
  return placed(extrude(outline, {}, -0.5 * width, 0.5 * width), profile_xz(), Vector3d::Zero());
}

TriangleMesh make_plate_with_holes(const Vector3d& size, int holes_x, int holes_y,
                                   double hole_diameter, int sides) {
  std::vector<Loop> holes;
  for (int i = 0; i < holes_x; ++i) {
    for (int j = 0; j < holes_y; ++j) {
      const Vector2d place(size.x() * ((i + 0.5) / holes_x - 0.5),
                           size.y() * ((j + 0.5) / holes_y - 0.5));
      holes.push_back(circle(place, 0.5 * hole_diameter, sides));
    }
  }
  return extrude(rectangle(Vector2d::Zero(), size.head<2>()), holes, -0.5 * size.z(),
                 0.5 * size.z());
}

}  // namespace spherule
