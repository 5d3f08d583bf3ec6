// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/scenes/work_cell.h"
#include "bench/studies/refined_cover.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace spherule {
namespace {

using test::Random;

// Not many spheres around the triangles, each of some of them that follow each other.
std::vector<Sphere> rough_cover(const TriangleMesh& mesh, std::size_t triangles) {
  std::vector<Sphere> spheres;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += triangles) {
    Eigen::AlignedBox3d box;
    for (std::size_t i = first; i < std::min(first + triangles, mesh.triangles.size()); ++i) {
      for (int k = 0; k < 3; ++k) {
        box.extend(mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])]);
      }
    }
    spheres.push_back({box.center(), 0.5 * box.diagonal().norm() * (1.0 + 1e-6)});
  }
  return spheres;
}

bool is_covered(const Eigen::Vector3d& point, const std::vector<Sphere>& spheres) {
  return std::any_of(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
    return (point - sphere.center).norm() <= sphere.radius * (1.0 + 1e-14);
  });
}

TEST(RefinedCover, CoversTheMeshWithinTheOldSpheres) {
  const TriangleMesh mesh = make_torch();
  const std::vector<Sphere> cover = rough_cover(mesh, 40);
  constexpr double kSlack = 1e-4;
  Random random(3);
  double largest_before = 0.0;
  for (const Sphere& sphere : cover) largest_before = std::max(largest_before, sphere.radius);
  for (const std::size_t factor : {4, 30}) {
    const auto spheres = refine_cover(mesh, cover, factor * cover.size(), kSlack);
    EXPECT_LE(spheres.size(), factor * cover.size());
    EXPECT_GT(spheres.size(), factor * cover.size() / 2);
    double largest = 0.0;
    for (const Sphere& sphere : spheres) {
      largest = std::max(largest, sphere.radius);
      EXPECT_TRUE(std::any_of(cover.begin(), cover.end(), [&](const Sphere& old) {
        return certainly_encloses({old.center, old.radius + 1.001 * kSlack}, sphere);
      }));
    }
    EXPECT_LT(largest, largest_before);
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      for (int sample = 0; sample < 4; ++sample) {
        double u = random.unit();
        double v = random.unit();
        if (u + v > 1.0) {
          u = 1.0 - u;
          v = 1.0 - v;
        }
        if (sample == 0) u = v = 0.0;  // a corner
        if (sample == 1) v = 0.0;      // an edge
        const Eigen::Vector3d point =
            corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
        ASSERT_TRUE(is_covered(point, spheres));
      }
    }
  }
}

TEST(RefinedCover, RefusesACoverWithAHole) {
  const TriangleMesh mesh = make_cube(1.0);
  std::vector<Sphere> cover = rough_cover(mesh, 1);
  EXPECT_NO_THROW(refine_cover(mesh, cover, 100, 0.01));
  for (Sphere& sphere : cover) sphere.radius *= 0.9;
  EXPECT_THROW(refine_cover(mesh, cover, 100, 0.01), Error);
}

TEST(CoarseCover, HoldsAllSpheres) {
  Random random(4);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 500; ++i) spheres.push_back({random.direction(), random.between(0.0, 0.2)});
  const SphereTree tree = build_tree(spheres);
  for (const std::size_t count : {1, 7, 8, 60, 500, 1000}) {
    const auto coarse = coarse_cover(tree, count);
    EXPECT_LE(coarse.size(), count);
    EXPECT_GT(8 * coarse.size(), std::min<std::size_t>(count, 500));
    for (const Sphere& sphere : spheres) {
      EXPECT_TRUE(std::any_of(coarse.begin(), coarse.end(), [&](const Sphere& outer) {
        return outer == sphere || certainly_encloses(outer, sphere);
      }));
    }
  }
}

TEST(FclPair, EverySettingAnswersAlike) {
  const TriangleMesh a = make_torch();
  const TriangleMesh b = make_cube(0.2);
  const FclSolid solid_a(a);
  const FclSolid solid_b(b);
  auto colliding = fcl_collide_engines(a, b);
  for (NamedPairEngine& named : fcl_boxed_collide_engines(a, b)) {
    colliding.push_back(std::move(named));
  }
  const auto measuring = fcl_distance_engines(a, b);
  Random random(5);
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i) {
    poses.emplace_back(random.rotation(), random.between(0.0, 0.6) * random.direction());
  }
  for (const auto& named : colliding) named.engine->set_poses(poses);
  for (const auto& named : measuring) named.engine->set_poses(poses);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double distance = surface_distance(solid_a, poses[i], solid_b, Pose());
    if (distance < 1e-6) continue;
    ++apart;
    for (const auto& named : colliding) EXPECT_FALSE(named.engine->collides(i)) << named.name;
    for (const auto& named : measuring) {
      EXPECT_NEAR(named.engine->distance(i), distance, 1e-4 * distance + 1e-6) << named.name;
    }
  }
  EXPECT_GT(apart, 20u);
  const std::vector<Pose> touching{Pose::from_translation({0.1, 0.0, 0.0})};
  ASSERT_TRUE(touch(solid_a, touching[0], solid_b, Pose()));
  ASSERT_LE(surface_distance(solid_a, touching[0], solid_b, Pose()), 0.0);
  for (const auto& named : colliding) {
    named.engine->set_poses(touching);
    EXPECT_TRUE(named.engine->collides(0)) << named.name;
  }
}

}  // namespace
}  // namespace spherule
