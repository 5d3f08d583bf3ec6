// SPDX-License-Identifier: BSD-3-Clause
// External spheres are where a tool of the least diameter can get, and nowhere else.
#include "simplifier/simplify.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// Whether a sphere of radius rho intersects nothing on the straight way, at points so close
// together that the clearance between two of them is known.
bool passes(const TriangleMesh& mesh, const Vector3d& from, const Vector3d& to, double rho) {
  const double length = (to - from).norm();
  double at = 0.0;
  while (true) {
    const Real room = judged_mesh_distance(from + at * (to - from), mesh) - rho;
    if (room < -1e-12L) return false;
    if (at >= 1.0) return true;
    // Nothing is met for `room`; a sphere that just fits steps on by a hair.
    const double way = std::max(static_cast<double>(room), 0.01 * rho);
    at = std::min(1.0, at + way / length);
  }
}

// Whether the sphere gets straight out of the box along an axis.
bool leaves(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box, const Vector3d& from,
            double rho) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool up : {false, true}) {
      Vector3d to = from;
      to[axis] = up ? std::max(from[axis], box.max()[axis] + rho)
                    : std::min(from[axis], box.min()[axis] - rho);
      if (to == from || passes(mesh, from, to, rho)) return true;
    }
  }
  return false;
}

// How many spheres a sphere of radius rho gets to from outside, straight from sphere to sphere.
std::size_t reached(const TriangleMesh& mesh, const ExternalSpheres& external) {
  const double rho = external.min_external_diameter / 2.0;
  const std::vector<Sphere>& spheres = external.spheres;
  std::vector<std::size_t> front, unseen;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    (leaves(mesh, external.box, spheres[i].center, rho) ? front : unseen).push_back(i);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const Sphere here = spheres[front[k]];
    std::erase_if(unseen, [&](std::size_t i) {
      const Sphere& there = spheres[i];
      if ((there.center - here.center).norm() >= there.radius + here.radius) return false;
      if (!passes(mesh, here.center, there.center, rho)) return false;
      front.push_back(i);
      return true;
    });
  }
  return front.size();
}

// A pipe with a lid on one end, bent at a right angle: its far part is reached through the bend
// only, and nothing in it leaves straight.
TriangleMesh bent_duct() {
  TriangleMesh mesh;
  const auto add = [&](const Vector3d& low, const Vector3d& high) {
    mesh = joined(mesh, box_mesh(low, high));
  };
  add({0, 0, 0}, {6, 3, 0.5});    // floor
  add({0, 0, 2.5}, {6, 3, 3});    // ceiling
  add({0, 0, 0}, {0.5, 6, 3});    // outer wall of the bend
  add({0, 0, 0}, {6, 0.5, 3});    // outer wall
  add({2.5, 2.5, 0}, {6, 3, 3});  // inner wall
  add({5.5, 0, 0}, {6, 3, 3});    // lid of the far part
  add({0, 3, 0}, {3, 6, 0.5});    // floor of the open part
  add({0, 3, 2.5}, {3, 6, 3});    // ceiling of the open part
  add({2.5, 2.5, 0}, {3, 6, 3});  // inner wall of the open part
  return mesh;
}

TEST(ExternalReach, EverySphereCanBeReachedFromOutside) {
  for (const TriangleMesh& mesh : effort(std::vector{pipe(2, 1.6, 4, 12), bent_duct()}, 1)) {
    for (const ExternalPlacement placement :
         {ExternalPlacement::kReachable, ExternalPlacement::kRandom}) {
      ExternalOptions options;
      options.placement = placement;
      options.min_external_diameter = 1.2;
      options.grid_step = kSanitized ? 0.4 : 0.3;
      options.limit = static_cast<std::size_t>(effort(800, 200));
      const ExternalSpheres external = place_external_spheres(mesh, options);
      EXPECT_EQ(reached(mesh, external), external.spheres.size());
    }
  }
}

TEST(ExternalReach, TheFarPartOfADuctIsOpenOnlyWhereTheWayThereIsWide) {
  const Vector3d far_part(4.0, 1.5, 1.5);
  ExternalOptions options;
  options.min_external_diameter = 1.2;
  options.grid_step = 0.2;
  const TriangleMesh duct = bent_duct();
  EXPECT_FALSE(is_in_solid(far_part, place_external_spheres(duct, options)));
  // A sill in the open part leaves a way of 1.1: what lies behind is filled.
  const TriangleMesh blocked = joined(duct, box_mesh({0.5, 4.5, 0.5}, {2.5, 4.8, 1.4}));
  for (const ExternalPlacement placement :
       {ExternalPlacement::kReachable, ExternalPlacement::kRandom}) {
    options.placement = placement;
    options.limit = 20000;
    EXPECT_TRUE(is_in_solid(far_part, place_external_spheres(blocked, options)));
  }
}

// A tool of spheres of diameter at least D and room for the grid, in a position that it reaches
// from outside, intersects S by no more than that room, unless it intersects M.
TEST(ExternalReach, NothingIsLostForToolsOfTheLeastDiameter) {
  Random random(61);
  int tried = 0;
  for (const TriangleMesh& mesh :
       {l_bracket(), pipe(1.0, 0.8, 1.0, 16), torus(1.0, 0.3, 16, 8), cube_mesh()}) {
    ExternalOptions options;
    options.min_external_diameter = 0.4;
    options.grid_step = 0.05;
    const ExternalSpheres external = place_external_spheres(mesh, options);
    // With so much room the place's own cell is reached, and its sphere is known up to that.
    const double slack = 2.0 * (0.8661 + 0.5) * external.grid_step;
    const double rho = (options.min_external_diameter + slack) / 2.0;
    const Vector3d margin = Vector3d::Constant(0.5);
    const Eigen::AlignedBox3d field(external.box.min() - margin, external.box.max() + margin);
    for (int i = 0; i < effort(1500, 200); ++i) {
      const Vector3d c = random.in_box(field);
      const auto room = static_cast<double>(judged_mesh_distance(c, mesh));
      if (room < rho || !leaves(mesh, external.box, c, rho)) continue;
      const double radius = std::min(room, random.between(rho, 3.0 * rho));
      ++tried;
      for (int k = 0; k < 20; ++k) {
        const double share = k % 2 == 0 ? 1.0 : random.unit();
        const Vector3d p = c + share * (radius - slack) * random.direction();
        ASSERT_FALSE(is_in_solid(p, external));
      }
    }
  }
  EXPECT_GT(tried, effort(1500, 200) / 2);
}

}  // namespace
}  // namespace spherule::test
