// SPDX-License-Identifier: BSD-3-Clause
// What does one query between two sphere trees cost, by distance of the bodies, and one forward
// kinematics? Counters: node tests and leaf tests a query, the share of queries that collide.

#include "collide/collide.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/random.h"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace spherule {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test::Random;

// Overlapping spheres along the surface of a torus of radii 0.3 m and 0.1 m: as many thin shells
// with a hole in the middle as a robot link or a pipe has.
SphereTree torus(int count) {
  const int around = std::max(3, static_cast<int>(std::sqrt(count * 0.3)));
  const int along = count / around;
  const double radius = 0.8 * 2.0 * std::numbers::pi * 0.1 / around;
  std::vector<Sphere> spheres;
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      const double u = 2.0 * std::numbers::pi * i / along;
      const double v = 2.0 * std::numbers::pi * j / around;
      const double ring = 0.3 + 0.1 * std::cos(v);
      spheres.push_back({{ring * std::cos(u), ring * std::sin(u), 0.1 * std::sin(v)}, radius});
    }
  }
  return build_tree(spheres);
}

struct PosePair {
  Pose a, b;
};

// Pairs in random directions, moved apart until the gap is `gap` (overlapping where negative).
std::vector<PosePair> pose_pairs(const SphereTree& a, const SphereTree& b, double gap) {
  Random random(1);
  std::vector<PosePair> result;
  for (int i = 0; i < 256; ++i) {
    const Quaterniond rotation_a = random.rotation();
    const Pose pose_a(rotation_a, random.point(1.0));
    const Quaterniond rotation_b = random.rotation();
    const Vector3d direction = random.direction();
    const auto at = [&](double distance) {
      return Pose(rotation_b, pose_a.translation() + distance * direction);
    };
    double low = 0.0;
    double high = 2.0;
    while (high - low > 1e-9) {
      const double middle = 0.5 * (low + high);
      (collides(a, pose_a, b, at(middle)) ? low : high) = middle;
    }
    result.push_back({pose_a, at(high + gap)});
  }
  return result;
}

// Millimetres between the surfaces, along the line of approach.
double gap_of(const benchmark::State& state) {
  return 1e-3 * static_cast<double>(state.range(1));
}

template <class Query>
void run(benchmark::State& state, const Query& query) {
  const SphereTree a = torus(static_cast<int>(state.range(0)));
  const SphereTree& b = a;
  const std::vector<PosePair> poses = pose_pairs(a, b, gap_of(state));
  std::size_t i = 0;
  for (auto _ : state) {
    const PosePair& pose = poses[i++ % poses.size()];
    benchmark::DoNotOptimize(query(a, pose.a, b, pose.b));
  }
  double node_tests = 0.0;
  double leaf_tests = 0.0;
  double collisions = 0.0;
  for (const PosePair& pose : poses) {
    const CollisionResult result = collide(a, pose.a, b, pose.b, {.max_pairs = 1});
    node_tests += static_cast<double>(result.cost.node_tests);
    leaf_tests += static_cast<double>(result.cost.leaf_tests);
    collisions += result.verdict == Verdict::kCollision ? 1.0 : 0.0;
  }
  const auto count = static_cast<double>(poses.size());
  state.counters["node_tests"] = node_tests / count;
  state.counters["leaf_tests"] = leaf_tests / count;
  state.counters["colliding"] = collisions / count;
}

void BM_DoTheyCollide(benchmark::State& state) {
  run(state, [](const auto&... arguments) { return collides(arguments...); });
}
void BM_WhichPairsCollide(benchmark::State& state) {
  run(state, [](const auto&... arguments) { return collide(arguments...).pairs.size(); });
}
void BM_HowFarApart(benchmark::State& state) {
  run(state, [](const auto&... arguments) { return distance(arguments...).lower; });
}

// Spheres a tree; gap in millimetres: far apart, near, almost touching, overlapping.
void scenes(benchmark::internal::Benchmark* benchmark) {
  for (const int spheres : {100, 1000, 10000}) {
    for (const int gap : {1000, 100, 10, 1, -1, -20}) benchmark->Args({spheres, gap});
  }
}
BENCHMARK(BM_DoTheyCollide)->Apply(scenes);
BENCHMARK(BM_WhichPairsCollide)->Apply(scenes);
BENCHMARK(BM_HowFarApart)->Apply(scenes);

// Six revolute joints of about the measures of an industrial arm.
void BM_WhereAreTheLinks(benchmark::State& state) {
  RobotModel robot;
  std::string parent = "base_link";
  Random random(2);
  for (int i = 0; i < 6; ++i) {
    const std::string name = "link_" + std::to_string(i + 1);
    Joint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    joint.type = JointType::kRevolute;
    joint.parent_from_joint = Pose::from_translation(random.point(1.0));
    joint.axis = i % 2 == 0 ? Vector3d::UnitZ() : Vector3d::UnitY();
    joint.lower = -3.0;
    joint.upper = 3.0;
    robot.add_link(name, parent, joint);
    parent = name;
  }
  std::vector<std::array<double, 6>> configurations(256);
  for (auto& configuration : configurations) {
    for (double& position : configuration) position = random.between(-3.0, 3.0);
  }
  std::vector<Pose> world_from_link;
  std::size_t i = 0;
  for (auto _ : state) {
    forward_kinematics(robot, configurations[i++ % configurations.size()], world_from_link);
    benchmark::DoNotOptimize(world_from_link.data());
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_WhereAreTheLinks);

}  // namespace
}  // namespace spherule
