// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/kinematics.h"
#include "collide/robot/robot_tree_checker.h"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace spherule {

// What is tested, in the order in which it is told of: links from the last to the first.
std::vector<RobotTreeChecker::TestedBody> RobotTreeChecker::tested_bodies() const {
  std::vector<TestedBody> result;
  for (const MechanismPair& pair : pairs_) {
    result.push_back(
        {&bodies_[static_cast<std::size_t>(pair.body)], static_cast<std::size_t>(pair.obstacle)});
  }
  for (const Standing& pair : standing_) result.push_back({&pair.body, pair.obstacle});
  std::sort(result.begin(), result.end(), [](const TestedBody& a, const TestedBody& b) {
    return std::tie(b.body->link, a.obstacle, a.body->tree_index) <
           std::tie(a.body->link, b.obstacle, b.body->tree_index);
  });
  return result;
}

std::optional<Contact> RobotTreeChecker::contact_of(const TestedBody& tested,
                                                    const Pose& world_from_link) const {
  const PlacedTree& other = obstacles_[tested.obstacle];
  const CoveredMesh* const mesh = obstacle_meshes_[tested.obstacle];
  if (tested.body->mesh == nullptr || mesh == nullptr) {
    return deepest_contact(*tested.body->tree, world_from_link, *other.tree, other.world_from_tree);
  }
  return deepest_contact(*tested.body->mesh, world_from_link, *mesh, other.world_from_tree);
}

std::vector<RobotContact> RobotTreeChecker::explain(std::span<const double> configuration,
                                                    Scratch& scratch,
                                                    const ExplainRequest& request) const {
  std::vector<RobotContact> result;
  if (!collides(configuration, scratch) || request.max_contacts == 0) return result;
  std::vector<Pose>& world_from_link = scratch.world_from_link_;
  forward_kinematics(robot_, configuration, world_from_link, world_from_root_);
  for (const TestedBody& tested : tested_bodies()) {
    const std::size_t link = tested.body->link;
    const bool is_known = !result.empty() && std::cmp_equal(result.back().link, link) &&
                          result.back().obstacle == tested.obstacle;
    if (!is_known && result.size() == request.max_contacts) break;
    const std::optional<Contact> contact = contact_of(tested, world_from_link[link]);
    if (!contact) continue;
    const RobotContact found{static_cast<int>(link), tested.body->tree_index, tested.obstacle,
                             *contact};
    if (!is_known) {
      result.push_back(found);
    } else if (contact->overlap_depth > result.back().contact.overlap_depth) {
      result.back() = found;
    }
  }
  assert(!result.empty());
  return result;
}

}  // namespace spherule
