// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/scene_setup.h"

#include "collide/point_cloud.h"
#include "collide/solid_mesh.h"
#include "robot/cover/link_mesh.h"
#include "robot/files/point_cloud_file.h"
#include "robot/files/srdf.h"
#include "robot/pairs/allowed_collisions.h"
#include "spheretree/build.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"
#include "spheretree/sphere_file.h"
#include "spheretree/tree_file.h"

#include <memory>
#include <utility>

namespace spherule {
namespace {

using SharedTree = std::shared_ptr<const SphereTree>;

SharedTree shared(SphereTree tree) {
  return std::make_shared<const SphereTree>(std::move(tree));
}

// A link of one shape that is a mesh.
LinkDescription link_of(const std::string& name, const MeshFile& mesh) {
  return {.name = name, .visual = {}, .collision = {LinkShape{{}, Pose(), mesh}}};
}

// Makes what is queried from the robot's scene.
class Preparation {
 public:
  Preparation(RobotModel robot, const SceneDescription& scene, const RobotCoverOptions& cover)
      : description_(scene), cover_(cover), scene_(std::move(robot), scene.world_from_root) {}

  PreparedScene run() && {
    allow_disabled_pairs();
    for (const SceneObstacle& obstacle : description_.obstacles) {
      ObstacleShape shape = std::visit(
          [&](const auto& source) { return shape_of(obstacle.name, source); }, obstacle.shape);
      scene_.add(obstacle.name, std::move(shape), obstacle.world_from_shape);
    }
    for (const SceneAttachment& object : description_.attached) {
      SharedTree tree =
          std::visit([&](const auto& source) { return tree_of(object, source); }, object.shape);
      scene_.attach(object.name, object.link, std::move(tree), object.link_from_object);
    }
    for (const SceneRegion& region : description_.regions) {
      scene_.define_region({region.body, region.name}, region.around);
    }
    for (const SceneContact& contact : description_.allowed_contacts) {
      if (contact.region.empty()) {
        scene_.allow_contact(contact.body, contact.other);
      } else {
        scene_.allow_contact(Region{contact.body, contact.region}, contact.other);
      }
    }
    for (const ScenePadding& padding : description_.padding) {
      if (padding.other.empty()) {
        scene_.set_padding(padding.body, padding.padding);
      } else {
        scene_.set_padding(padding.body, padding.other, padding.padding);
      }
    }
    return {std::move(scene_), std::move(warnings_)};
  }

 private:
  void allow_disabled_pairs() {
    if (!description_.srdf) return;
    AllowedCollisions allowed = scene_.allowed_collisions();
    for (const DisabledPair& pair : read_srdf(*description_.srdf).disabled_pairs) {
      const RobotModel& robot = scene_.robot();
      if (robot.find_link(pair.link_a) < 0 || robot.find_link(pair.link_b) < 0) continue;
      allowed.allow(pair.link_a, pair.link_b);
    }
    scene_.set_allowed_collisions(std::move(allowed));
  }

  ObstacleShape shape_of(const std::string&, const Primitive& primitive) { return primitive; }
  ObstacleShape shape_of(const std::string& name, const MeshFile& file) {
    auto solid = std::make_shared<const SolidMesh>(*link_mesh(link_of(name, file)));
    if (!solid->is_closed()) {
      warnings_.push_back(name + ": the mesh is open; what is in it without touching it is free");
    }
    return solid;
  }
  ObstacleShape shape_of(const std::string&, const PointsSource& source) {
    return shared(build_tree(point_spheres(source)));
  }
  ObstacleShape shape_of(const std::string&, const SpheresSource& source) {
    return read_spheres(source);
  }
  ObstacleShape shape_of(const std::string&, const TreeSource& source) {
    return shared(load_tree(source.path));
  }

  static SharedTree read_spheres(const SpheresSource& source) {
    return shared(build_tree(load_spheres(source.path).spheres));
  }

  SharedTree tree_of(const SceneAttachment&, const SpheresSource& source) {
    return read_spheres(source);
  }
  SharedTree tree_of(const SceneAttachment&, const TreeSource& source) {
    return shared(load_tree(source.path));
  }
  SharedTree tree_of(const SceneAttachment& object, const MeshFile& file) {
    RobotCoverOptions options = cover_;
    options.geometry = LinkGeometry::kCollision;
    options.links = {};
    if (object.max_error > 0.0) {
      options.max_error = object.max_error;
      options.min_external_diameter = 0.0;
    }
    const RobotCover covered =
        cover_robot({object.name, RobotModel(object.name), {link_of(object.name, file)}}, options);
    const LinkCover& link = covered.links.front();
    if (!link.fit || !link.fit->certificate.covered) {
      throw Error(file.path.string(), "its spheres are not proved to cover all of it");
    }
    for (const std::string& warning : link.warnings) {
      warnings_.push_back(object.name + ": " + warning);
    }
    return shared(build_tree(link.spheres));
  }

  const SceneDescription& description_;
  const RobotCoverOptions& cover_;
  RobotScene scene_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<Sphere> point_spheres(const PointsSource& source) {
  const PointCloudFile cloud = read_point_cloud(source.path, source.scale);
  return point_cloud_spheres(cloud.points, add_up(source.radius, cloud.point_error),
                             {.voxel = source.voxel});
}

PreparedScene prepare_scene(RobotModel robot, const SceneDescription& scene,
                            const RobotCoverOptions& cover) {
  return Preparation(std::move(robot), scene, cover).run();
}

}  // namespace spherule
