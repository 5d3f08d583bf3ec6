// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/joined_scene.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace spherule::internal {
namespace {

void add(JoinedSpheres& joined, int part, const SphereTree& tree, const Pose& pose) {
  const std::span<const Sphere> spheres = tree.spheres();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    joined.spheres.push_back({pose * spheres[i].center, spheres[i].radius});
    joined.origins.push_back({part, static_cast<std::int32_t>(i)});
  }
}

}  // namespace

JoinedScene::JoinedScene(std::span<const MechanismBody> all_bodies,
                         std::span<const MechanismObstacle> all_obstacles,
                         std::span<const MechanismPair> all_pairs) {
  std::vector<std::set<int>> met_by(all_obstacles.size());
  for (const MechanismPair& pair : all_pairs) {
    met_by[static_cast<std::size_t>(pair.obstacle)].insert(pair.body);
  }
  std::map<std::set<int>, int> obstacle_groups;
  std::vector<int> group_of_obstacle(all_obstacles.size(), -1);
  for (std::size_t i = 0; i < all_obstacles.size(); ++i) {
    if (met_by[i].empty()) continue;
    const auto [group, is_new] =
        obstacle_groups.emplace(met_by[i], static_cast<int>(obstacles.size()));
    if (is_new) obstacles.emplace_back();
    group_of_obstacle[i] = group->second;
    add(obstacles[static_cast<std::size_t>(group->second)], static_cast<int>(i),
        *all_obstacles[i].tree, all_obstacles[i].root_from_tree);
  }

  std::vector<std::vector<int>> intersects(all_bodies.size());  // groups, in the order of the pairs
  for (const MechanismPair& pair : all_pairs) {
    std::vector<int>& groups = intersects[static_cast<std::size_t>(pair.body)];
    const int group = group_of_obstacle[static_cast<std::size_t>(pair.obstacle)];
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::map<std::pair<int, std::vector<int>>, int> body_groups;
  std::vector<char> is_added(all_bodies.size(), 0);
  for (const MechanismPair& pair : all_pairs) {
    const auto body = static_cast<std::size_t>(pair.body);
    if (std::exchange(is_added[body], 1) != 0) continue;
    const int frame = all_bodies[body].frame;
    const auto [group, is_new] =
        body_groups.emplace(std::pair(frame, intersects[body]), static_cast<int>(bodies.size()));
    if (is_new) {
      bodies.push_back({.frame = frame});
      for (const int obstacle : intersects[body]) pairs.push_back({group->second, obstacle});
    }
    add(bodies[static_cast<std::size_t>(group->second)], pair.body, *all_bodies[body].tree,
        all_bodies[body].frame_from_tree);
  }
}

}  // namespace spherule::internal
