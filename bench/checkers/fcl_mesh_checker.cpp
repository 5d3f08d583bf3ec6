// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/fcl_mesh_checker.h"

#include "base/error.h"
#include "bench/checkers/sphere_checkers.h"
#include "tests/support/fcl_models.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/solids.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Of one obstacle, what stands in the place of its mesh.
struct ConvexParts {
  std::size_t obstacle;
  const std::vector<TriangleMesh>& parts;
};

std::shared_ptr<fcl::Convex<double>> convex(const TriangleMesh& part) {
  auto vertices =
      std::make_shared<std::vector<fcl::Vector3d>>(part.vertices.begin(), part.vertices.end());
  auto faces = std::make_shared<std::vector<int>>();  // each its number of corners and then these
  for (const Eigen::Vector3i& t : part.triangles) {
    faces->insert(faces->end(), {3, t[0], t[1], t[2]});
  }
  return std::make_shared<fcl::Convex<double>>(
      std::move(vertices), static_cast<int>(part.triangles.size()), std::move(faces));
}

template <class Volume>
class BoxesThenMeshes : public SingleChecker {
 public:
  explicit BoxesThenMeshes(const Workload& workload, const ConvexParts* convex_parts = nullptr)
      : SingleChecker(workload.robot) {
    for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
      const Part& part = workload.obstacles[i].part;
      const auto pose = fcl_pose<S>(workload.obstacles[i].world_from_part);
      if constexpr (std::is_same_v<S, double>) {
        if (convex_parts != nullptr && convex_parts->obstacle == i) {
          for (const TriangleMesh& mesh : convex_parts->parts) {
            const auto placed_part = placed(mesh, pose.linear(), pose.translation());
            static_.push_back({convex(mesh), pose, bounding_box(placed_part), i});
          }
          continue;
        }
      }
      const FclModel<Volume> model(part.mesh);
      static_.push_back({model.geometry, pose, model.world_box(pose), i});
    }
    for (const Body& body : workload.bodies) {
      bodies_.push_back(
          {FclModel<Volume>(body.part.mesh), static_cast<std::size_t>(body.link), {}});
      for (std::size_t i = 0; i < static_.size(); ++i) {
        if (is_tested(body, workload.obstacles[static_[i].obstacle])) {
          bodies_.back().against.push_back(i);
        }
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    for (const Moving& body : bodies_) {
      const auto pose = fcl_pose<S>(world_from_link[body.link]);
      const auto box = body.model.world_box(pose);
      for (const std::size_t i : body.against) {
        const Static& other = static_[i];
        if (box.intersects(other.box) &&
            fcl_meshes_touch<Volume>(*body.model.geometry, pose, *other.geometry, other.pose)) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  using S = typename Volume::S;
  struct Static {
    std::shared_ptr<const fcl::CollisionGeometry<S>> geometry;
    fcl::Transform3<S> pose;
    Eigen::AlignedBox<S, 3> box;
    std::size_t obstacle;
  };
  struct Moving {
    FclModel<Volume> model;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Static> static_;
  std::vector<Moving> bodies_;
};

template <class Volume>
class ManagerThenMeshes : public SingleChecker {
 public:
  explicit ManagerThenMeshes(const Workload& workload) : SingleChecker(workload.robot) {
    for (const Obstacle& obstacle : workload.obstacles) {
      obstacles_.push_back(std::make_unique<fcl::CollisionObject<S>>(
          FclModel<Volume>(obstacle.part.mesh).geometry, fcl_pose<S>(obstacle.world_from_part)));
      manager_.registerObject(obstacles_.back().get());
    }
    manager_.setup();
    for (const Body& body : workload.bodies) {
      Moving moving{
          std::make_unique<fcl::CollisionObject<S>>(FclModel<Volume>(body.part.mesh).geometry),
          static_cast<std::size_t>(body.link),
          {}};
      for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
        if (!is_tested(body, workload.obstacles[i])) moving.left_out.push_back(obstacles_[i].get());
      }
      bodies_.push_back(std::move(moving));
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    for (const Moving& body : bodies_) {
      body.object->setTransform(fcl_pose<S>(world_from_link[body.link]));
      body.object->computeAABB();
      Query query{&body, false};
      manager_.collide(body.object.get(), &query, &visit);
      if (query.hit) return true;
    }
    return false;
  }

 private:
  using S = typename Volume::S;
  struct Moving {
    std::unique_ptr<fcl::CollisionObject<S>> object;
    std::size_t link;
    std::vector<const fcl::CollisionObject<S>*> left_out;
  };
  struct Query {
    const Moving* body;
    bool hit;
  };

  // True ends the search.
  static bool visit(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* data) {
    Query& query = *static_cast<Query*>(data);
    for (const auto* left_out : query.body->left_out) {
      if (a == left_out || b == left_out) return false;
    }
    query.hit = fcl_meshes_touch<Volume>(*a->collisionGeometry(), a->getTransform(),
                                         *b->collisionGeometry(), b->getTransform());
    return query.hit;
  }

  std::vector<std::unique_ptr<fcl::CollisionObject<S>>> obstacles_;
  fcl::DynamicAABBTreeCollisionManager<S> manager_;
  std::vector<Moving> bodies_;
};

template <class Volume>
std::unique_ptr<Checker> make(const Workload& workload, FclMeshSetting::Front front) {
  if (front == FclMeshSetting::Front::kBoxes) {
    return std::make_unique<BoxesThenMeshes<Volume>>(workload);
  }
  return std::make_unique<ManagerThenMeshes<Volume>>(workload);
}

}  // namespace

std::string to_string(const FclMeshSetting& setting) {
  return std::string(setting.volume == FclMeshSetting::Volume::kObb ? "OBB" : "OBBRSS") +
         (setting.precision == FclMeshSetting::Precision::kDouble ? " double" : " float") +
         (setting.front == FclMeshSetting::Front::kBoxes ? ", boxes" : ", manager");
}

std::vector<FclMeshSetting> all_fcl_mesh_settings() {
  std::vector<FclMeshSetting> settings;
  for (const auto volume : {FclMeshSetting::Volume::kObb, FclMeshSetting::Volume::kObbRss}) {
    for (const auto precision :
         {FclMeshSetting::Precision::kDouble, FclMeshSetting::Precision::kFloat}) {
      for (const auto front : {FclMeshSetting::Front::kBoxes, FclMeshSetting::Front::kManager}) {
        settings.push_back({volume, precision, front});
      }
    }
  }
  return settings;
}

std::unique_ptr<Checker> make_fcl_mesh_checker(const Workload& workload,
                                               const FclMeshSetting& setting) {
  const bool is_double = setting.precision == FclMeshSetting::Precision::kDouble;
  if (setting.volume == FclMeshSetting::Volume::kObb) {
    return is_double ? make<fcl::OBB<double>>(workload, setting.front)
                     : make<fcl::OBB<float>>(workload, setting.front);
  }
  return is_double ? make<fcl::OBBRSS<double>>(workload, setting.front)
                   : make<fcl::OBBRSS<float>>(workload, setting.front);
}

std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts) {
  if (parts.empty()) throw Error(workload.name, "no convex parts");
  const ConvexParts convex_parts{obstacle, parts};
  return std::make_unique<BoxesThenMeshes<fcl::OBBRSS<double>>>(workload, &convex_parts);
}

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
