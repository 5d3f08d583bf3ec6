// SPDX-License-Identifier: BSD-3-Clause
#include "bench/brute_force_checker.h"

#include <cstddef>
#include <vector>

namespace spherule {
namespace {

// Distances in this cell stay below 8 m, where a float's unit in the last place is 0.5 micrometres;
// three coordinates, the square and the radii lose less than ten of them.
constexpr float kPad = 5e-6F;

class BruteForceChecker : public SingleChecker {
 public:
  explicit BruteForceChecker(const Workload& workload) : SingleChecker(workload.robot) {
    for (const Obstacle& obstacle : workload.obstacles) {
      Arrays arrays;
      for (const Sphere& sphere : obstacle.part.tree->spheres()) {
        const Eigen::Vector3f center = (obstacle.world_from_part * sphere.center).cast<float>();
        arrays.x.push_back(center.x());
        arrays.y.push_back(center.y());
        arrays.z.push_back(center.z());
        arrays.radius.push_back(static_cast<float>(sphere.radius) + kPad);
      }
      obstacles_.push_back(std::move(arrays));
    }
    for (const Body& body : workload.bodies) {
      Moving moving{body.part.tree, static_cast<std::size_t>(body.link), {}};
      for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
        if (is_tested(body, workload.obstacles[i])) moving.against.push_back(i);
      }
      bodies_.push_back(std::move(moving));
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    for (const Moving& body : bodies_) {
      const Pose& pose = world_from_link[body.link];
      for (const Sphere& sphere : body.tree->spheres()) {
        const Eigen::Vector3f center = (pose * sphere.center).cast<float>();
        for (const std::size_t obstacle : body.against) {
          if (obstacles_[obstacle].hit(center, static_cast<float>(sphere.radius))) return true;
        }
      }
    }
    return false;
  }

 private:
  struct Arrays {
    std::vector<float> x, y, z, radius;

    // Does not stop at the first hit: that would keep the loop from being vectorised.
    bool hit(const Eigen::Vector3f& center, float r) const {
      int hits = 0;
      const std::size_t count = x.size();
      const float cx = center.x();
      const float cy = center.y();
      const float cz = center.z();
      for (std::size_t i = 0; i < count; ++i) {
        const float dx = x[i] - cx;
        const float dy = y[i] - cy;
        const float dz = z[i] - cz;
        const float reach = radius[i] + r;
        hits |= dx * dx + dy * dy + dz * dz <= reach * reach ? 1 : 0;
      }
      return hits != 0;
    }
  };
  struct Moving {
    std::shared_ptr<const SphereTree> tree;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Arrays> obstacles_;
  std::vector<Moving> bodies_;
};

}  // namespace

std::unique_ptr<Checker> make_brute_force_checker(const Workload& workload) {
  return std::make_unique<BruteForceChecker>(workload);
}

}  // namespace spherule
