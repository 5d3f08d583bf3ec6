// SPDX-License-Identifier: BSD-3-Clause
// G7: verdicts and pair lists are the same on every machine, as a hash of them. Half of the spheres
// are in contact up to rounding, where the last bit of the canonical test decides.
#include "collide/collide.h"
#include "collide/meshes/mesh_tree.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/hash.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace spherule::test {
namespace {

constexpr int kScenes = 1000;

void add(const CollisionResult& result, std::ostream& text) {
  text << static_cast<int>(result.verdict);
  for (const SpherePair& pair : result.pairs) text << ' ' << pair.a << ':' << pair.b;
  text << '\n';
}

// Numbers are drawn in separate statements wherever the order of evaluation is not fixed.
Pose golden_pose(Random& random, double size) {
  const Eigen::Quaterniond rotation = random.quaternion();
  return Pose(rotation, random.point(size));
}

double distance_of(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  const double x = p.x() - q.x(), y = p.y() - q.y(), z = p.z() - q.z();
  return std::sqrt(x * x + y * y + z * z);
}

// Random spheres, every second of which touches a point of the other set, up to the test's pad.
std::vector<Sphere> spheres_near(Random& random, const Pose& world_from_spheres,
                                 const Pose& world_from_points,
                                 const std::vector<Eigen::Vector3d>& points) {
  std::vector<Sphere> spheres = random_spheres(random, 20, 1.0, 0.1);
  for (std::size_t i = 1; i < spheres.size(); i += 2) {
    const Eigen::Vector3d p =
        world_from_spheres.inverse() * (world_from_points * points[i % points.size()]);
    const double gap = random.between(-1e-13, 1e-13);
    spheres[i].center = p + 0.1 * random.point(1.0);
    spheres[i].radius = std::max(0.0, distance_of(spheres[i].center, p) + gap);
  }
  return spheres;
}

std::vector<Eigen::Vector3d> random_points(Random& random, int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.point(1.0));
  return points;
}

TEST(Golden, PairsOfSpheres) {
  constexpr std::uint64_t kGolden = 0x44f945caf442076e;
  Random random(1);
  std::ostringstream text;
  for (int i = 0; i < kScenes; ++i) {
    const std::vector<Eigen::Vector3d> points = random_points(random, 20);
    std::vector<Sphere> second;
    for (const Eigen::Vector3d& point : points) second.push_back({point, 0.0});
    const Pose world_from_a = golden_pose(random, 1.0);
    const Pose world_from_b = golden_pose(random, i % 2 == 0 ? 1.0 : 5.0);
    const std::vector<Sphere> first = spheres_near(random, world_from_a, world_from_b, points);
    add(collide(build_tree(first), world_from_a, build_tree(second), world_from_b), text);
  }
  const std::uint64_t hash = hash_of(text.str());
  EXPECT_EQ(hash, kGolden) << "0x" << std::hex << hash;
}

TEST(Golden, PairsOfSpheresAndTriangles) {
  constexpr std::uint64_t kGolden = 0xeba7c128466af6d5;
  Random random(2);
  std::ostringstream text;
  for (int i = 0; i < kScenes; ++i) {
    TriangleMesh mesh;
    mesh.vertices = random_points(random, 24);
    for (int k = 0; k < 24; k += 3) mesh.triangles.emplace_back(k, k + 1, k + 2);
    const Pose world_from_a = golden_pose(random, 1.0);
    const Pose world_from_b = golden_pose(random, i % 2 == 0 ? 1.0 : 5.0);
    const std::vector<Sphere> spheres =
        spheres_near(random, world_from_a, world_from_b, mesh.vertices);
    add(collide(build_tree(spheres), world_from_a, MeshTree(mesh), world_from_b), text);
  }
  const std::uint64_t hash = hash_of(text.str());
  EXPECT_EQ(hash, kGolden) << "0x" << std::hex << hash;
}

}  // namespace
}  // namespace spherule::test
