// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/bullet_pair_test.h"
#include "bench/checkers/sphere_checkers.h"

#include <bullet/btBulletCollisionCommon.h>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace spherule {
namespace {

class Compound {
 public:
  Compound(const SphereTree& tree, double pad)
      : shape_(true, static_cast<int>(tree.spheres().size())) {
    for (const Sphere& sphere : tree.spheres()) {
      spheres_.push_back(
          std::make_unique<btSphereShape>(static_cast<btScalar>(sphere.radius + pad)));
      shape_.addChildShape(btTransform(btQuaternion::getIdentity(), bullet_vector(sphere.center)),
                           spheres_.back().get());
    }
    shape_.getDynamicAabbTree()->optimizeTopDown();
    object_.setCollisionShape(&shape_);
  }
  Compound(const Compound&) = delete;
  Compound& operator=(const Compound&) = delete;

  void place(const Pose& pose) {
    object_.setWorldTransform(bullet_pose(pose));
    shape_.getAabb(object_.getWorldTransform(), low_, high_);
  }

  bool box_overlaps(const Compound& other) const {
    return TestAabbAgainstAabb2(low_, high_, other.low_, other.high_);
  }

  const btTransform& pose() const { return object_.getWorldTransform(); }
  btCollisionObject& object() { return object_; }
  const btDbvtNode* root() const { return shape_.getDynamicAabbTree()->m_root; }
  const btVector3& center(int child) const { return shape_.getChildTransform(child).getOrigin(); }
  btScalar radius(int child) const {
    return spheres_[static_cast<std::size_t>(child)]->getRadius();
  }

 private:
  std::vector<std::unique_ptr<btSphereShape>> spheres_;
  btCompoundShape shape_;
  btCollisionObject object_;
  btVector3 low_{0, 0, 0};  // box in the world
  btVector3 high_{0, 0, 0};
};

class ContactPairTest {
 public:
  bool operator()(Compound& a, Compound& b) { return touch_(a.object(), b.object()); }

 private:
  BulletPairTest touch_;
};

// What btCompoundCompoundCollisionAlgorithm does in MycollideTT().
class TreeWalk {
 public:
  bool operator()(const Compound& a, const Compound& b) {
    const btTransform a_from_b = a.pose().inverse() * b.pose();
    stack_.clear();
    stack_.emplace_back(a.root(), b.root());
    while (!stack_.empty()) {
      const btDbvt::sStkNN pair = stack_.back();
      stack_.pop_back();
      if (!boxes_overlap(pair, a_from_b)) continue;
      if (pair.a->isleaf() && pair.b->isleaf()) {
        if (spheres_touch(a, pair.a->dataAsInt, b, pair.b->dataAsInt, a_from_b)) return true;
      } else if (pair.b->isleaf()) {
        for (const btDbvtNode* child : pair.a->childs) stack_.emplace_back(child, pair.b);
      } else if (pair.a->isleaf()) {
        for (const btDbvtNode* child : pair.b->childs) stack_.emplace_back(pair.a, child);
      } else {
        for (const btDbvtNode* of_b : pair.b->childs) {
          for (const btDbvtNode* of_a : pair.a->childs) stack_.emplace_back(of_a, of_b);
        }
      }
    }
    return false;
  }

 private:
  static bool boxes_overlap(const btDbvt::sStkNN& pair, const btTransform& a_from_b) {
    btVector3 low;
    btVector3 high;
    btTransformAabb(pair.b->volume.Mins(), pair.b->volume.Maxs(), 0, a_from_b, low, high);
    return Intersect(pair.a->volume, btDbvtAabbMm::FromMM(low, high));
  }

  static bool spheres_touch(const Compound& a, int child_a, const Compound& b, int child_b,
                            const btTransform& a_from_b) {
    const btScalar reach = a.radius(child_a) + b.radius(child_b);
    return (a_from_b * b.center(child_b) - a.center(child_a)).length2() <= reach * reach;
  }

  std::vector<btDbvt::sStkNN> stack_;
};

template <class Query>
class BulletSphereChecker : public SingleChecker {
 public:
  explicit BulletSphereChecker(const Workload& workload) : SingleChecker(workload.robot) {
    const double pad = single_precision_pad(scene_reach(workload));
    for (const Obstacle& obstacle : workload.obstacles) {
      obstacles_.push_back(std::make_unique<Compound>(*obstacle.part.tree, pad));
      obstacles_.back()->place(obstacle.world_from_part);
    }
    for (const Body& body : workload.bodies) {
      bodies_.push_back({std::make_unique<Compound>(*body.part.tree, pad),
                         static_cast<std::size_t>(body.link),
                         {}});
      for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
        if (!is_tested(body, workload.obstacles[i])) continue;
        bodies_.back().against.push_back(obstacles_[i].get());
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    for (const Moving& body : bodies_) {
      body.compound->place(world_from_link[body.link]);
      for (Compound* obstacle : body.against) {
        if (body.compound->box_overlaps(*obstacle) && query_(*body.compound, *obstacle)) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  struct Moving {
    std::unique_ptr<Compound> compound;
    std::size_t link;
    std::vector<Compound*> against;
  };
  std::vector<std::unique_ptr<Compound>> obstacles_;
  std::vector<Moving> bodies_;
  Query query_;
};

}  // namespace

std::unique_ptr<Checker> make_bullet_sphere_checker(const Workload& workload, BulletQuery query) {
  if (query == BulletQuery::kContactPairTest) {
    return std::make_unique<BulletSphereChecker<ContactPairTest>>(workload);
  }
  return std::make_unique<BulletSphereChecker<TreeWalk>>(workload);
}

}  // namespace spherule
