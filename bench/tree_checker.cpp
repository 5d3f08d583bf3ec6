// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tree_checker.h"

#include "collide/collide.h"

#include <memory>
#include <vector>

namespace spherule {
namespace {

class TreeChecker : public SingleChecker {
 public:
  explicit TreeChecker(const Workload& workload) : SingleChecker(workload.robot) {
    for (const Body& body : workload.bodies) {
      for (const Obstacle& obstacle : workload.obstacles) {
        if (!is_tested(body, obstacle)) continue;
        pairs_.push_back({body.part.tree, static_cast<std::size_t>(body.link), obstacle.part.tree,
                          obstacle.world_from_part});
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    for (const Pair& pair : pairs_) {
      if (spherule::collides(*pair.body, world_from_link[pair.link], *pair.obstacle,
                             pair.world_from_obstacle)) {
        return true;
      }
    }
    return false;
  }

 private:
  struct Pair {
    std::shared_ptr<const SphereTree> body;
    std::size_t link;
    std::shared_ptr<const SphereTree> obstacle;
    Pose world_from_obstacle;
  };
  std::vector<Pair> pairs_;
};

}  // namespace

std::unique_ptr<Checker> make_tree_checker(const Workload& workload) {
  return std::make_unique<TreeChecker>(workload);
}

}  // namespace spherule
