// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/fcl_convex_checker.h"

#include "base/error.h"
#include "bench/baseline/convex_hull.h"
#include "tests/support/fcl_models.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/solids.h"

#include <fcl/geometry/shape/convex.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <utility>

namespace spherule {
namespace {

using Model = FclModel<fcl::OBBRSS<double>>;
using Box = Eigen::AlignedBox3d;

std::shared_ptr<fcl::Convex<double>> convex(const TriangleMesh& part) {
  auto vertices =
      std::make_shared<std::vector<fcl::Vector3d>>(part.vertices.begin(), part.vertices.end());
  auto faces = std::make_shared<std::vector<int>>(polygon_list(part));
  return std::make_shared<fcl::Convex<double>>(
      std::move(vertices), static_cast<int>(part.triangles.size()), std::move(faces));
}

class MeshesAndConvexParts : public SingleChecker {
 public:
  MeshesAndConvexParts(const Workload& workload, std::size_t obstacle,
                       const std::vector<TriangleMesh>& parts)
      : SingleChecker(workload.robot) {
    for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
      const Obstacle& standing = workload.obstacles[i];
      const auto pose = fcl_pose<double>(standing.world_from_part);
      if (i != obstacle) {
        const Model model(standing.part.mesh);
        static_.push_back({model.geometry, pose, model.world_box(pose), i});
        continue;
      }
      for (const TriangleMesh& part : parts) {
        const Box box = bounding_box(placed(part, pose.linear(), pose.translation()));
        static_.push_back({convex(part), pose, box, i});
      }
    }
    for (const Body& body : workload.bodies) {
      bodies_.push_back({Model(body.part.mesh), static_cast<std::size_t>(body.link), {}});
      for (std::size_t i = 0; i < static_.size(); ++i) {
        if (is_tested(body, workload.obstacles[static_[i].obstacle])) {
          bodies_.back().against.push_back(i);
        }
      }
    }
  }

 protected:
  bool collides(std::span<const Pose> world_from_link) override {
    return std::any_of(bodies_.begin(), bodies_.end(), [&](const Moving& body) {
      const auto pose = fcl_pose<double>(world_from_link[body.link]);
      const Box box = body.model.world_box(pose);
      return std::any_of(body.against.begin(), body.against.end(), [&](std::size_t i) {
        const Static& other = static_[i];
        if (!box.intersects(other.box)) return false;
        const fcl::CollisionRequest<double> request;  // one contact, not kept
        fcl::CollisionResult<double> result;
        return fcl::collide(body.model.geometry.get(), pose, other.geometry.get(), other.pose,
                            request, result) > 0;
      });
    });
  }

 private:
  struct Static {
    std::shared_ptr<const fcl::CollisionGeometry<double>> geometry;
    fcl::Transform3<double> pose;
    Box box;
    std::size_t obstacle;
  };
  struct Moving {
    Model model;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Static> static_;
  std::vector<Moving> bodies_;
};

}  // namespace

std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts) {
  if (parts.empty()) throw Error(workload.name, "no convex parts");
  return std::make_unique<MeshesAndConvexParts>(workload, obstacle, parts);
}

}  // namespace spherule
