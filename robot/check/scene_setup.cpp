// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/scene_setup.h"

#include "base/error.h"
#include "base/files.h"
#include "base/rounding.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/point_cloud.h"
#include "robot/check/robot_scene.h"
#include "robot/cover/robot_spheres.h"
#include "robot/files/format_text.h"
#include "robot/files/robot_description.h"
#include "robot/files/scene_file.h"
#include "robot/pairs/allowed_collisions.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

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

// A file and the numbers with which it is read, bit by bit.
using SourceKey = std::pair<std::filesystem::path, std::array<std::uint64_t, 4>>;

SourceKey key_of(const std::filesystem::path& file, const std::array<double, 4>& numbers = {}) {
  return {file.lexically_normal(), std::bit_cast<std::array<std::uint64_t, 4>>(numbers)};
}

SourceKey key_of(const MeshFile& file, double max_error = 0.0) {
  return key_of(file.path, {file.scale.x(), file.scale.y(), file.scale.z(), max_error});
}

// What a scene names again, as one bottle on every shelf, is read and made once, and shared.
template <class Made>
class MadeOnce {
 public:
  template <class Make>
  const Made& get(const SourceKey& key, const Make& make) {
    const auto found = made_.find(key);
    return found != made_.end() ? found->second : made_.emplace(key, make()).first->second;
  }

 private:
  std::map<SourceKey, Made> made_;
};

constexpr std::size_t kMostRepeatedNodes = std::size_t{1} << 22;

std::size_t nodes_of(const SphereTree& tree) {
  return tree.node_count();
}

std::size_t nodes_of(const SolidMesh& solid) {
  return solid.mesh().tree().node_count();
}

struct FileOf {
  std::filesystem::path operator()(const Primitive&) const { return {}; }
  template <class Source>
  std::filesystem::path operator()(const Source& source) const {
    return source.path.lexically_normal();
  }
};

// Of what stands for a file where nothing is made of it.
constexpr double kStandInRadius = 1.0;

struct CoveredFile {
  SharedTree tree;
  std::vector<std::string> warnings;
};

// Makes what is queried from the robot's scene.
class Preparation {
 public:
  Preparation(RobotModel robot, const SceneDescription& scene, const RobotCoverOptions& cover)
      : description_(scene), cover_(cover), scene_(std::move(robot), scene.world_from_root) {}

  PreparedScene run(std::span<const DisabledPair> ignored) && {
    allow_disabled_pairs(ignored);
    for (const SceneObstacle& obstacle : description_.obstacles) {
      ObstacleShape shape = std::visit(
          [&](const auto& source) { return shape_of(obstacle.name, source); }, obstacle.shape);
      const std::filesystem::path file = std::visit(FileOf(), obstacle.shape);
      std::visit([&](const auto& made) { count_repeated(obstacle.name, file, made); }, shape);
      scene_.add(obstacle.name, std::move(shape), obstacle.world_from_shape);
    }
    for (const SceneAttachment& object : description_.attached) {
      SharedTree tree =
          std::visit([&](const auto& source) { return tree_of(object, source); }, object.shape);
      count_repeated(object.name, std::visit(FileOf(), object.shape), tree);
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
    set_paddings();
    return {std::move(scene_), std::move(warnings_)};
  }

  // The same with stand-ins for what files hold: they are read, but nothing is made of them.
  void rehearse() && {
    allow_disabled_pairs({});
    for (const SceneObstacle& obstacle : description_.obstacles) {
      const auto stand_in = [&](const auto& source) { return stand_in_of(obstacle.name, source); };
      scene_.add(obstacle.name, std::visit(stand_in, obstacle.shape), obstacle.world_from_shape);
    }
    const std::array<Sphere, 1> sphere = {Sphere{Eigen::Vector3d::Zero(), kStandInRadius}};
    const SharedTree tree = shared(build_tree(sphere));
    for (const SceneAttachment& object : description_.attached) {
      std::visit([&](const auto& source) { stand_in_of(object.name, source); }, object.shape);
      scene_.attach(object.name, object.link, tree, object.link_from_object);
    }
    // Of regions the spheres are not known.
    for (const SceneRegion& region : description_.regions) scene_.set_padding(region.body, 0.0);
    for (const SceneContact& contact : description_.allowed_contacts) {
      scene_.allow_contact(contact.body, contact.other);
    }
    set_paddings();
  }

 private:
  void set_paddings() {
    for (const ScenePadding& padding : description_.padding) {
      if (padding.other.empty()) {
        scene_.set_padding(padding.body, padding.padding);
      } else {
        scene_.set_padding(padding.body, padding.other, padding.padding);
      }
    }
  }

  void allow_disabled_pairs(std::span<const DisabledPair> ignored) {
    AllowedCollisions allowed = scene_.allowed_collisions();
    allowed.allow(ignored);
    if (description_.srdf) apply_srdf(allowed);
    scene_.set_allowed_collisions(std::move(allowed));
  }

  void apply_srdf(AllowedCollisions& allowed) {
    require_regular_file(*description_.srdf);
    const SemanticDescription semantics = read_srdf(*description_.srdf);
    warnings_.insert(warnings_.end(), semantics.warnings.begin(), semantics.warnings.end());
    allowed.apply(semantics);
    for (const auto& [first, second] : enabled_only(semantics)) {
      for (const std::string& link : {first, second}) {
        if (scene_.robot().find_link(link) >= 0) continue;
        warnings_.push_back(description_.srdf->string() + ": enable_collisions names link '" +
                            link + "', which the robot does not have: the pair is not enabled");
      }
    }
  }

  // A small file that stands in many places, shared or read with other numbers each time, is held
  // for each of them.
  template <class Shape>
  void count_repeated(const std::string& name, const std::filesystem::path& file,
                      const std::shared_ptr<const Shape>& shape) {
    if (!files_.insert(file).second) repeated_nodes_ += nodes_of(*shape);
    if (repeated_nodes_ > kMostRepeatedNodes) {
      throw Error(name, "the trees, clouds and meshes that the scene repeats have more than " +
                            std::to_string(kMostRepeatedNodes) + " nodes");
    }
  }
  void count_repeated(const std::string&, const std::filesystem::path&, const Primitive&) {}

  ObstacleShape shape_of(const std::string&, const Primitive& primitive) { return primitive; }
  ObstacleShape shape_of(const std::string& name, const MeshFile& file) {
    const auto& solid = solids_.get(key_of(file), [&] {
      return std::make_shared<const SolidMesh>(*link_mesh(link_of(name, file)));
    });
    if (!solid->is_closed()) {
      warnings_.push_back(name + ": the mesh is open; what is in it without touching it is free");
    }
    return solid;
  }
  ObstacleShape shape_of(const std::string&, const PointsSource& source) {
    return clouds_.get(key_of(source.path, {source.scale, source.radius, source.voxel, 0.0}),
                       [&] { return shared(build_tree(point_spheres(source))); });
  }
  ObstacleShape shape_of(const std::string&, const SpheresSource& source) {
    return tree_of(source);
  }
  ObstacleShape shape_of(const std::string&, const TreeSource& source) { return tree_of(source); }

  ObstacleShape stand_in_of(const std::string&, const Primitive& primitive) { return primitive; }
  template <class Source>
  ObstacleShape stand_in_of(const std::string& name, const Source& source) {
    if (read_.insert(source.path.lexically_normal()).second) read_once(name, source);
    return SolidSphere{kStandInRadius};
  }

  static void read_once(const std::string& name, const MeshFile& file) {
    require_regular_file(file.path);
    link_mesh(link_of(name, file));
  }
  static void read_once(const std::string&, const PointsSource& source) {
    require_regular_file(source.path);
    read_point_cloud(source.path, source.scale);
  }
  template <class Source>
  void read_once(const std::string&, const Source& source) {
    tree_of(source);
  }

  SharedTree tree_of(const SpheresSource& source) {
    return spheres_.get(key_of(source.path), [&] {
      require_regular_file(source.path);
      return shared(build_tree(internal::load_spheres_in_metres(source.path)));
    });
  }
  SharedTree tree_of(const TreeSource& source) {
    return trees_.get(key_of(source.path), [&] {
      require_regular_file(source.path);
      return shared(load_tree(source.path));
    });
  }

  template <class Source>
  SharedTree tree_of(const SceneAttachment&, const Source& source) {
    return tree_of(source);
  }
  SharedTree tree_of(const SceneAttachment& object, const MeshFile& file) {
    const CoveredFile& covered =
        covered_.get(key_of(file, object.max_error), [&] { return cover(object, file); });
    for (const std::string& warning : covered.warnings) {
      warnings_.push_back(object.name + ": " + warning);
    }
    return covered.tree;
  }

  CoveredFile cover(const SceneAttachment& object, const MeshFile& file) const {
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
    return {shared(build_tree(link.spheres)), link.warnings};
  }

  const SceneDescription& description_;
  const RobotCoverOptions cover_;
  RobotScene scene_;
  std::vector<std::string> warnings_;
  MadeOnce<std::shared_ptr<const SolidMesh>> solids_;
  MadeOnce<SharedTree> clouds_, spheres_, trees_;
  MadeOnce<CoveredFile> covered_;
  std::set<std::filesystem::path> files_, read_;
  std::size_t repeated_nodes_ = 0;  // of shapes from these files, beyond the first of each
};

}  // namespace

std::vector<Sphere> point_spheres(const PointsSource& source) {
  require_regular_file(source.path);
  const PointCloudFile cloud = read_point_cloud(source.path, source.scale);
  return point_cloud_spheres(cloud.points, add_up(source.radius, cloud.point_error),
                             {.voxel = source.voxel});
}

PreparedScene prepare_scene(RobotModel robot, const SceneDescription& scene,
                            const RobotCoverOptions& cover, std::span<const DisabledPair> ignored) {
  return Preparation(std::move(robot), scene, cover).run(ignored);
}

void check_scene_names(RobotModel robot, const SceneDescription& scene) {
  Preparation(std::move(robot), scene, RobotCoverOptions()).rehearse();
}

}  // namespace spherule
