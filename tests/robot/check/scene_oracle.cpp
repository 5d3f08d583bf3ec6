// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/check/scene_oracle.h"

#include "collide/meshes/solid_mesh.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/solid_oracle.h"
#include "tests/support/exact/poses.h"
#include "tests/support/zoo.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace spherule::test {
namespace {

using Long = long double;

Vector<Long> in_world(const OracleBody& body, const Eigen::Vector3d& center,
                      std::span<const Pose> world_from_link) {
  const Vector<Long> p = transform(body.link_from_spheres, exact<Long>(center));
  if (body.link < 0) return p;
  return transform(world_from_link[static_cast<std::size_t>(body.link)], p);
}

std::vector<std::vector<Sphere>> spheres_of(
    const std::vector<std::shared_ptr<const SphereTree>>& trees) {
  std::vector<std::vector<Sphere>> result;
  for (const auto& tree : trees) {
    result.emplace_back(tree->spheres().begin(), tree->spheres().end());
  }
  return result;
}

}  // namespace

bool moves_against(const RobotModel& robot, int first, int second) {
  // The link that stands for all that is rigidly joined to it.
  const auto group = [&](int link) {
    for (;;) {
      const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
      if (joint < 0 || robot.joints()[static_cast<std::size_t>(joint)].moves()) return link;
      link = robot.joints()[static_cast<std::size_t>(joint)].parent_link;
    }
  };
  return group(first) != group(second);
}

long double OracleScene::gap_of(const OraclePair& pair,
                                std::span<const Pose> world_from_link) const {
  const OracleBody& a = bodies[pair.first];
  const OracleBody& b = bodies[pair.second];
  std::vector<std::pair<Vector<Long>, Long>> others;
  for (const auto& tree : b.trees) {
    for (const Sphere& sphere : tree) {
      others.emplace_back(in_world(b, sphere.center, world_from_link), Long{sphere.radius});
    }
  }
  Long least = std::numeric_limits<Long>::infinity();
  for (std::size_t tree = 0; tree < a.trees.size(); ++tree) {
    for (std::size_t i = 0; i < a.trees[tree].size(); ++i) {
      const BodySphere id{tree, static_cast<std::int32_t>(i)};
      if (std::find(pair.left_out.begin(), pair.left_out.end(), id) != pair.left_out.end()) {
        continue;
      }
      const Sphere& sphere = a.trees[tree][i];
      const Vector<Long> center = in_world(a, sphere.center, world_from_link);
      for (const auto& [other, radius] : others) {
        least =
            std::min(least, std::sqrt(squared_distance(center, other)) - sphere.radius - radius);
      }
    }
  }
  return least - pair.padding - a.padding - b.padding;
}

std::optional<long double> OracleScene::gap(std::span<const double> configuration,
                                            std::size_t* nearest) const {
  std::vector<Pose> world_from_link;
  forward_kinematics(robot, configuration, world_from_link, world_from_root);
  std::optional<long double> least;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Long gap = gap_of(pairs[i], world_from_link);
    if (std::isinf(gap) || (least && gap >= *least)) continue;
    least = gap;
    if (nearest != nullptr) *nearest = i;
  }
  return least;
}

namespace {

// What a scene is told of two bodies, and so the oracle; nothing if they may touch.
std::optional<OraclePair> random_pair(Random& random, RobotScene& scene, const OracleScene& oracle,
                                      std::size_t k, std::size_t i) {
  const OracleBody& first = oracle.bodies[k];
  const OracleBody& second = oracle.bodies[i];
  OraclePair pair{k, i, 0.0L, {}};
  if (random.whole(0, 7) == 0) {
    pair.padding = random.between(0.0, 0.03);
    const bool swapped = second.link >= 0 && random.whole(0, 1) == 0;
    scene.set_padding(swapped ? second.name : first.name, swapped ? first.name : second.name,
                      static_cast<double>(pair.padding));
  }
  if (random.whole(0, 7) == 0) {
    scene.allow_contact(first.name, second.name);
    if (random.whole(0, 1) == 0) return std::nullopt;
    scene.forbid_contact(first.name, second.name);
  }
  if (random.whole(0, 3) == 0 && !first.trees.empty()) {
    for (std::size_t tree = 0; tree < first.trees.size(); ++tree) {
      for (std::size_t s = 0; s < first.trees[tree].size(); ++s) {
        if (random.whole(0, 3) == 0) pair.left_out.push_back({tree, static_cast<int>(s)});
      }
    }
    if (!pair.left_out.empty()) {
      const Region region{first.name, "for " + second.name};
      scene.define_region(region, pair.left_out);
      scene.allow_contact(region, second.name);
    }
  }
  return pair;
}

}  // namespace

RandomScene random_scene(Random& random) {
  const RobotModel robot = random_robot_with_trees(random, 0.4);
  const Pose world_from_root = random.whole(0, 1) == 0 ? Pose() : random.pose(3.0);
  RandomScene result{RobotScene(robot, world_from_root), {robot, world_from_root, {}, {}}};
  auto& [scene, oracle] = result;
  AllowedCollisions allowed(robot);
  const auto links = static_cast<int>(robot.links().size());
  for (int n = random.whole(0, 2 * links); n > 0 && links > 1; --n) {
    const int first = random.whole(0, links - 2);
    allowed.allow(first, random.whole(first + 1, links - 1), AllowedReason::kGiven);
  }
  scene.set_allowed_collisions(allowed);
  for (int i = 0; i < links; ++i) {
    const Link& link = robot.links()[static_cast<std::size_t>(i)];
    oracle.bodies.push_back({link.name, i, Pose(), spheres_of(link.trees)});
  }
  for (int n = random.whole(0, 2); n > 0; --n) {
    const int link = random.whole(0, links - 1);
    const std::string name = "object_" + std::to_string(n);
    const auto tree = random_tree(random, 0.4);
    const Pose pose = random.pose(0.3);
    scene.attach(name, robot.links()[static_cast<std::size_t>(link)].name, tree, pose);
    oracle.bodies.push_back({name, link, pose, spheres_of({tree})});
  }
  const std::size_t bodies = oracle.bodies.size();
  for (int n = random.whole(0, 3); n > 0; --n) {
    const std::string name = "obstacle_" + std::to_string(n);
    const auto tree = random_tree(random, 0.6);
    const Pose pose = random.pose(2.0);
    scene.add(name, tree, pose);
    oracle.bodies.push_back({name, -1, pose, spheres_of({tree})});
  }
  for (std::size_t i = 0; i < bodies; ++i) {
    if (random.whole(0, 3) > 0) continue;
    oracle.bodies[i].padding = random.between(0.0, 0.03);
    scene.set_padding(oracle.bodies[i].name, static_cast<double>(oracle.bodies[i].padding));
  }
  for (std::size_t i = 0; i < oracle.bodies.size(); ++i) {
    for (std::size_t k = 0; k < std::min(i, bodies); ++k) {
      const OracleBody& first = oracle.bodies[k];
      const OracleBody& second = oracle.bodies[i];
      if (second.link >= 0) {
        const bool are_links = i < static_cast<std::size_t>(links);
        if (are_links ? allowed.allows(first.name, second.name)
                      : !moves_against(robot, first.link, second.link)) {
          continue;
        }
      }
      std::optional<OraclePair> pair = random_pair(random, scene, oracle, k, i);
      if (pair) oracle.pairs.push_back(*std::move(pair));
    }
  }
  return result;
}

TriangleMesh mesh_of_kind(int kind) {
  switch (kind) {
    case 0:
      return box_mesh(Eigen::Vector3d(-1, -0.5, -0.5), Eigen::Vector3d(1, 0.5, 0.5));
    case 1:
      return icosphere(3);
    case 2:
      return torus(1.0, 0.3, 24, 12);
    case 3:
      return needles(12);
    case 4:
      return open_box();
    case 5:
      return nested_shells(3);
    case 6:
      return with_degenerates(inverted(icosphere(2)));
    default:
      return soup(60, 7);
  }
}

namespace {

// Of a random kind and size, the largest of which hold the whole robot.
std::shared_ptr<const SolidMesh> random_solid(Random& random) {
  TriangleMesh mesh = mesh_of_kind(random.whole(0, kMeshKinds - 1));
  const double size = random.whole(0, 9) < 2 ? 20.0 : random.between(0.05, 2.0);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= size;
  mesh.vertex_error = random.whole(0, 1) == 0 ? 0.0 : random.between(0.0, 0.05);
  return std::make_shared<const SolidMesh>(mesh);
}

}  // namespace

RandomScene scene_with_solids(Random& random) {
  RandomScene result = random_scene(random);
  for (int i = random.whole(0, 4); i > 0; --i) {
    const double size = random.whole(0, 9) == 0 ? 100.0 : random.whole(0, 9) == 0 ? 1e-3 : 0.3;
    const bool is_half_space = random.whole(0, 4) == 0;
    const Primitive solid = is_half_space ? HalfSpace{} : random_primitive(random, 2.0 * size);
    result.scene.add("solid_" + std::to_string(i), solid,
                     random.pose(is_half_space ? 4.0 : 3.0 + size));
  }
  for (int i = random.whole(0, 2); i > 0; --i) {
    result.scene.add("mesh_" + std::to_string(i), random_solid(random), random.pose(3.0));
  }
  return result;
}

}  // namespace spherule::test
