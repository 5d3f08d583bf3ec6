// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_sphere_checker.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>
#include <vector>

namespace spherule {
namespace {

using Object = fcl::CollisionObjectd;
using Manager = fcl::DynamicAABBTreeCollisionManagerd;

// True ends the search.
bool visit(Object* a, Object* b, void* data) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  const bool hit = fcl::collide(a, b, request, result) > 0;
  *static_cast<bool*>(data) = hit;
  return hit;
}

class SphereGroup {
 public:
  void add(const Part& part, const Pose& pose) {
    for (const Sphere& sphere : part.tree->spheres()) {
      objects_.push_back(std::make_unique<Object>(std::make_shared<fcl::Sphered>(sphere.radius)));
      centers_.push_back(sphere.center);
      place(objects_.size() - 1, pose);
      manager_.registerObject(objects_.back().get());
    }
  }
  void setup() { manager_.setup(); }
  void update() { manager_.update(); }

  std::size_t size() const { return objects_.size(); }
  void place(std::size_t i, const Pose& pose) {
    objects_[i]->setTranslation(pose * centers_[i]);
    objects_[i]->computeAABB();
  }

  bool collides(SphereGroup& other) {
    bool hit = false;
    manager_.collide(&other.manager_, &hit, &visit);
    return hit;
  }

 private:
  std::vector<std::unique_ptr<Object>> objects_;
  std::vector<Eigen::Vector3d> centers_;
  Manager manager_;
};

class FclSphereChecker : public SingleChecker {
 public:
  explicit FclSphereChecker(const Workload& workload) : SingleChecker(workload.robot) {
    for (const Obstacle& obstacle : workload.obstacles) {
      obstacles_.push_back(std::make_unique<SphereGroup>());
      obstacles_.back()->add(obstacle.part, obstacle.world_from_part);
      obstacles_.back()->setup();
    }
    for (const Body& body : workload.bodies) {
      // The root link never moves; it has a group of its own, judged here once and for all.
      if (body.link == 0) {
        SphereGroup root;
        root.add(body.part, Pose());
        root.setup();
        for (std::size_t i = 0; i < obstacles_.size(); ++i) {
          if (is_tested(body, workload.obstacles[i])) root_hits_ |= root.collides(*obstacles_[i]);
        }
        continue;
      }
      moving_.add(body.part, Pose());
      links_.resize(moving_.size(), static_cast<std::size_t>(body.link));
    }
    moving_.setup();
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    if (root_hits_) return true;
    for (std::size_t i = 0; i < links_.size(); ++i) moving_.place(i, world_from_link[links_[i]]);
    moving_.update();
    for (const auto& obstacle : obstacles_) {
      if (moving_.collides(*obstacle)) return true;
    }
    return false;
  }

 private:
  std::vector<std::unique_ptr<SphereGroup>> obstacles_;
  SphereGroup moving_;
  std::vector<std::size_t> links_;  // of each moving sphere
  bool root_hits_ = false;
};

}  // namespace

std::unique_ptr<Checker> make_fcl_sphere_checker(const Workload& workload) {
  return std::make_unique<FclSphereChecker>(workload);
}

}  // namespace spherule
