// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/broadphase_callback.h"
#include "base/error.h"
#include "tests/adapters/fcl/models.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace spherule {
namespace {

namespace api = fcl_api;

template <class Manager>
class FclBroadphase : public ::testing::Test {
 protected:
  void SetUp() override {
    test::Random random(1);
    for (int i = 0; i < 40; ++i) {
      const auto model = test::covered_model(random.index(2) == 0 ? "cube" : "bracket");
      objects.push_back(
          std::make_unique<fcl::CollisionObjectd>(model, test::random_transform(random, 1000.0)));
      manager.registerObject(objects.back().get());
    }
    manager.setup();
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  Manager manager;
};

using Managers = std::conditional_t<
    test::kSanitized, ::testing::Types<fcl::DynamicAABBTreeCollisionManagerd>,
    ::testing::Types<fcl::NaiveCollisionManagerd, fcl::SaPCollisionManagerd,
                     fcl::SSaPCollisionManagerd, fcl::DynamicAABBTreeCollisionManagerd>>;
TYPED_TEST_SUITE(FclBroadphase, Managers);

// One object against all that are managed: as asking each.
TYPED_TEST(FclBroadphase, AnswersAsAskingEveryPair) {
  test::Random random(2);
  int collisions = 0;
  for (int i = 0; i < 60; ++i) {
    fcl::CollisionObjectd probe(test::covered_model("probe"),
                                test::random_transform(random, 1200.0));
    std::size_t contacts = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& object : this->objects) {
      api::CollisionResultd result;
      contacts += api::collide(object.get(), &probe, api::CollisionRequestd(1000), result);
      api::DistanceResultd distance;
      nearest =
          std::min(nearest, api::distance(object.get(), &probe, api::DistanceRequestd(), distance));
    }
    api::DefaultCollisionData<double> all;
    all.request.num_max_contacts = 100000;
    this->manager.collide(&probe, &all, api::DefaultCollisionFunction<double>);
    EXPECT_EQ(all.result.numContacts(), contacts);
    EXPECT_FALSE(all.done);
    api::DefaultCollisionData<double> any;
    this->manager.collide(&probe, &any, api::DefaultCollisionFunction<double>);
    EXPECT_EQ(any.result.numContacts(), contacts > 0 ? 1u : 0u);
    EXPECT_EQ(any.done, contacts > 0);
    api::DefaultDistanceData<double> distance;
    this->manager.distance(&probe, &distance, api::DefaultDistanceFunction<double>);
    EXPECT_EQ(distance.result.min_distance, nearest);
    collisions += contacts > 0;
  }
  EXPECT_GT(collisions, 2);
  EXPECT_LT(collisions, 50);
}

TYPED_TEST(FclBroadphase, AnObjectWithoutSpheresIsAnError) {
  fcl::CollisionObjectd bare(test::fcl_model<fcl::OBBRSSd>(test::fcl_test_mesh("probe")),
                             this->objects.front()->getTransform());
  api::DefaultCollisionData<double> data;
  EXPECT_THROW(this->manager.collide(&bare, &data, api::DefaultCollisionFunction<double>), Error);
  api::DefaultDistanceData<double> distance;
  EXPECT_THROW(this->manager.distance(&bare, &distance, api::DefaultDistanceFunction<double>),
               Error);
}

}  // namespace
}  // namespace spherule
