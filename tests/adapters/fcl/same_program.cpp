// SPDX-License-Identifier: BSD-3-Clause
// A program as users of FCL write it, compiled twice. What they edit to replace FCL stands between
// #ifdef and #else: the header and the namespace, and one line where a model is made.
#include "tests/adapters/fcl/same_program.h"

#ifdef PROGRAM_WITH_SPHERULE
#include "adapters/fcl/collide.h"
namespace api = spherule::fcl_api;
#define PROGRAM(name) name##_spherule
#else
#include <fcl/broadphase/default_broadphase_callbacks.h>
namespace api = fcl;
#define PROGRAM(name) name##_fcl
#endif

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

namespace spherule::test {
namespace {

std::shared_ptr<api::CollisionGeometryd> make_geometry(const ProgramModel& source) {
  std::vector<fcl::Vector3d> vertices(source.mesh.vertices.begin(), source.mesh.vertices.end());
  std::vector<fcl::Triangle> triangles;
  for (const Eigen::Vector3i& t : source.mesh.triangles) {
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  }
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
#ifdef PROGRAM_WITH_SPHERULE
  return api::sphere_model(*model, {.fit = {.max_error = source.max_error, .effort = 0},
                                    .confirm_on_triangles = source.confirm_on_triangles});
#else
  return model;
#endif
}

std::vector<std::shared_ptr<api::CollisionGeometryd>> make_geometries(
    const std::vector<ProgramModel>& models) {
  std::vector<std::shared_ptr<api::CollisionGeometryd>> geometries;
  for (const ProgramModel& model : models) geometries.push_back(make_geometry(model));
  return geometries;
}

std::unique_ptr<fcl::BroadPhaseCollisionManagerd> make_manager(const std::string& name) {
  if (name == "DynamicAABBTree") {
    return std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
  }
  if (name == "DynamicAABBTreeArray") {
    return std::make_unique<fcl::DynamicAABBTreeCollisionManager_Arrayd>();
  }
  if (name == "SaP") return std::make_unique<fcl::SaPCollisionManagerd>();
  if (name == "SSaP") return std::make_unique<fcl::SSaPCollisionManagerd>();
  if (name == "IntervalTree") return std::make_unique<fcl::IntervalTreeCollisionManagerd>();
  if (name == "Naive") return std::make_unique<fcl::NaiveCollisionManagerd>();
  throw std::out_of_range(name);
}

ObjectPairs colliding_pairs(const fcl::BroadPhaseCollisionManagerd& manager,
                            const std::vector<api::CollisionObjectd>& objects) {
  struct Query {
    const std::vector<api::CollisionObjectd>& objects;
    ObjectPairs found;
  } query{objects, {}};
  manager.collide(&query, [](api::CollisionObjectd* o1, api::CollisionObjectd* o2, void* data) {
    auto& [all, found] = *static_cast<Query*>(data);
    api::DefaultCollisionData<double> narrow;
    api::DefaultCollisionFunction<double>(o1, o2, &narrow);
    const auto i1 = static_cast<std::size_t>(o1 - all.data());
    const auto i2 = static_cast<std::size_t>(o2 - all.data());
    if (narrow.result.isCollision()) found.emplace_back(std::min(i1, i2), std::max(i1, i2));
    return false;
  });
  std::sort(query.found.begin(), query.found.end());
  return query.found;
}

}  // namespace

std::vector<PairAnswer> PROGRAM(query_pairs)(const std::vector<ProgramModel>& models,
                                             const std::vector<PlacedPair>& pairs, bool distances) {
  const auto geometries = make_geometries(models);
  std::vector<PairAnswer> answers;
  for (const PlacedPair& pair : pairs) {
    PairAnswer answer;
    const api::CollisionRequestd request(1, false);
    api::CollisionResultd result;
    answer.geometry_collides = api::collide(geometries[pair.a].get(), pair.tf_a,
                                            geometries[pair.b].get(), pair.tf_b, request, result);
    const api::CollisionObjectd a(geometries[pair.a], pair.tf_a);
    const api::CollisionObjectd b(geometries[pair.b], pair.tf_b);
    result.clear();
    api::collide(&a, &b, request, result);
    answer.object_collides = result.isCollision();
    if (distances && !answer.object_collides) {
      const api::DistanceRequestd distance_request(true);
      api::DistanceResultd distance_result;
      answer.distance = api::distance(&a, &b, distance_request, distance_result);
    }
    answers.push_back(answer);
  }
  return answers;
}

std::vector<ObjectPairs> PROGRAM(query_managers)(const std::vector<std::string>& names,
                                                 const std::vector<ProgramModel>& models,
                                                 const std::vector<PlacedModel>& placed) {
  const auto geometries = make_geometries(models);
  std::vector<api::CollisionObjectd> objects;
  for (const PlacedModel& p : placed) objects.emplace_back(geometries[p.model], p.tf);
  std::vector<ObjectPairs> answers;
  for (const std::string& name : names) {
    const auto manager = make_manager(name);
    // Registered one by one, FCL's SaPCollisionManager loses pairs, of FCL's own models too.
    std::vector<api::CollisionObjectd*> pointers;
    for (api::CollisionObjectd& object : objects) pointers.push_back(&object);
    manager->registerObjects(pointers);
    manager->setup();
    answers.push_back(colliding_pairs(*manager, objects));
  }
  return answers;
}

}  // namespace spherule::test
