// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A robot and what is around it, to be edited and then queried.
//
// @code{.cpp}
// #include <spherule/robot/check/robot_scene.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{1, 0, 0}, 0.1}};
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// robot.attach("arm", std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres)));
// spherule::RobotScene scene(robot);
// const auto world_from_table = spherule::Pose::from_translation({0, 0, -0.2});
// scene.add("table", spherule::Box{.size = {2, 2, 0.1}}, world_from_table);
// scene.set_padding("arm", 0.01);
// const spherule::RobotChecker checker = scene.snapshot();
// spherule::RobotChecker::Scratch scratch(checker);
// assert(checker.check_config(std::vector{0.5}, scratch));
// @endcode

#include "collide/meshes/solid_mesh.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "robot/check/robot_checker.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace spherule {

class LinkPairs;
class SolidMesh;

// What may stand in the way, in metres. A cloud of points is the tree that point_cloud_tree() makes
// of it.
using ObstacleShape =
    std::variant<std::shared_ptr<const SphereTree>, std::shared_ptr<const SolidMesh>, Primitive>;

// A sphere of a link or an attached object.
struct BodySphere {
  std::size_t tree = 0;     // among the link's; 0 for an attached object
  std::int32_t sphere = 0;  // index into the tree's spheres()
  // In the order of the members.
  friend auto operator<=>(const BodySphere&, const BodySphere&) = default;
};

// A named part of a link or of an attached object: the tip of a wire, the jaws of a gripper.
struct Region {
  std::string body;
  std::string name;
};

// A robot and what is around it, to be edited; snapshot() makes what is queried. Lengths in metres.
//
// Names. Links, attached objects and obstacles share one space of names: a name that is taken, or
// is not there, is an Error that says so. Links and attached objects are bodies.
//
// What is tested: every body against every obstacle; two links against each other unless
// AllowedCollisions allows them (at first it allows, among others, links that no joint moves
// against each other); and an attached object against a link or another attached object if a joint
// moves one against the other. An attached object moves with its link but has no part in what that
// link is allowed: a long tool is tested against the links next to its flange. Contacts that are
// intended are taken out, by allow_contact().
class RobotScene {
 public:
  // The spheres are those that the robot's links carry. Allowed at first: what AllowedCollisions
  // allows by itself, which throws Error for a robot of more than AllowedCollisions::kMaxLinks
  // links.
  explicit RobotScene(RobotModel robot, const Pose& world_from_root = {});

  // What the scene was made with and what was set last.
  const RobotModel& robot() const { return robot_; }
  const AllowedCollisions& allowed_collisions() const { return allowed_; }
  // What they allow as rigid or adjacent, though it is not so by this robot's own joints and
  // spheres (they may come from a model whose links had no spheres yet), is tested again. Throws
  // Error for those of a robot with other links.
  void set_allowed_collisions(AllowedCollisions allowed);

  // What is proved of the pairs of links (prove_link_pairs()); null, as at first: nothing. Where
  // two links are proved free of each other they are free whatever their spheres say: in the
  // configurations of their boxes, and on motions that stay in these. The bodies that the proofs
  // are about have to be what the spheres of the links stand for: all of them. Pairs with padding
  // are tested everywhere. Throws Error for proofs of another robot, or of a tool.
  void set_link_pairs(std::shared_ptr<const LinkPairs> pairs);
  // What is proved of an attached object and all links, by prove_attached_pairs(); forgotten with
  // the object. That tool, in its link's frame, has to be what the object's spheres stand for where
  // the object is attached: the scene knows spheres alone and cannot compare. Throws Error, too,
  // for an unknown object, and for proofs of a tool on another link.
  void set_attached_pairs(std::string_view object, std::shared_ptr<const LinkPairs> pairs);
  // Why two links are not tested against each other, or not everywhere: what is allowed, and then
  // what is proved. Throws Error for names that are no links.
  AllowedReason reason(std::string_view first, std::string_view second) const;

  // Adds an obstacle at a pose in the world. Throws Error for a name that is taken or empty, a
  // missing tree or mesh, or a primitive that require_primitive() refuses.
  void add(std::string name, ObstacleShape shape, const Pose& world_from_shape = {});
  // Moves an obstacle to another pose. Throws Error for an unknown obstacle.
  void move(std::string_view obstacle, const Pose& world_from_shape);
  // Removes an obstacle, with all contacts and paddings that name it. Throws Error for an unknown
  // obstacle.
  void remove(std::string_view obstacle);
  // The names of the obstacles, in alphabetical order.
  std::vector<std::string> obstacles() const;

  // Attaches spheres to a link, with which they move. Throws Error as add() does, and for an
  // unknown link.
  void attach(std::string name, std::string_view link, std::shared_ptr<const SphereTree> tree,
              const Pose& link_from_object = {});
  // Detaches an object, and removes all contacts, paddings and regions that name it. Throws Error
  // for an unknown object.
  void detach(std::string_view object);
  // The names of what is attached, in alphabetical order.
  std::vector<std::string> attached() const;

  // Every sphere of the body grows by so much. At least 0, otherwise Error; 0 at first.
  void set_padding(std::string_view body, double padding);
  // The two are kept apart by so much more: two bodies, or a body and an obstacle.
  void set_padding(std::string_view body, std::string_view other, double padding);

  // Names some spheres of a body; a region of that name that was there is replaced. Regions may
  // share spheres. Throws Error for spheres that are not there, for none, and for more than
  // kMostRegionSpheres in all regions.
  void define_region(Region region, std::span<const BodySphere> spheres);
  // Names the spheres of a body whose centres lie in `around`, a sphere in the frame of the link,
  // or of the object; otherwise as above.
  void define_region(Region region, const Sphere& around);

  // A body and an obstacle, or two bodies, may touch: they are not tested any more.
  void allow_contact(std::string_view body, std::string_view other);
  // Only the region may touch; the rest of the body is tested as before.
  void allow_contact(const Region& region, std::string_view other);
  // Takes back what allow_contact() allowed of a body; what was not allowed stays as it is.
  void forbid_contact(std::string_view body, std::string_view other);
  // Takes back what allow_contact() allowed of a region; what was not allowed stays as it is.
  void forbid_contact(const Region& region, std::string_view other);

  // An obstacle, with the last arguments of add() and move(); for programs that show or store a
  // scene.
  struct Obstacle {
    ObstacleShape shape;
    Pose world_from_shape;
  };
  // An attached object, with the last arguments of attach() and set_attached_pairs().
  struct Attached {
    std::string link;
    std::shared_ptr<const SphereTree> tree;
    Pose link_from_object;
    std::shared_ptr<const LinkPairs> pairs{};
  };
  // An intended contact: of a body, or its region unless that name is empty, and another.
  struct Intended {
    std::string body;
    std::string region;
    std::string other;
    // In the order of the members.
    friend auto operator<=>(const Intended&, const Intended&) = default;
  };
  // Two names: of bodies, or of a body and a region.
  using NamePair = std::pair<std::string, std::string>;
  // Where the robot stands, with a unit rotation.
  const Pose& world_from_root() const { return world_from_root_; }
  // The last argument of set_link_pairs().
  const std::shared_ptr<const LinkPairs>& link_pairs() const { return link_pairs_; }
  // The obstacle of that name; throws Error where there is none.
  const Obstacle& obstacle(std::string_view name) const;
  // The attached object of that name; throws Error where there is none.
  const Attached& attached(std::string_view name) const;
  // The padding of bodies, their names in alphabetical order.
  const std::map<std::string, double, std::less<>>& padding() const { return padding_; }
  // The padding of pairs, the names of each in alphabetical order.
  const std::map<NamePair, double>& pair_padding() const { return pair_padding_; }
  // The spheres of each region, by the names of body and region, sorted.
  const std::map<NamePair, std::vector<BodySphere>>& regions() const { return regions_; }
  // Contacts that allow_contact() allows and forbid_contact() has not forbidden since.
  const std::set<Intended>& intended_contacts() const { return intended_; }

  // Pairs of bodies, and of bodies and obstacles, that a snapshot may have to test.
  static constexpr std::size_t kMostBodyPairs = std::size_t{1} << 19;
  static constexpr std::size_t kMostObstaclePairs = std::size_t{1} << 23;
  // Nodes of trees that it may make of bodies with padding or regions, and spheres of all regions.
  static constexpr std::size_t kMostCopiedNodes = std::size_t{1} << 24;
  static constexpr std::size_t kMostRegionSpheres = std::size_t{1} << 24;

  // What is queried, as of now: later edits do not change it. Trees and meshes are shared, not
  // copied, but for those of bodies that have padding or regions. Throws Error for what reaches
  // too far to be computed with, more than the limits above, a mesh of the options that is
  // missing, and instructions that this machine has not got.
  RobotChecker snapshot(const RobotCheckerOptions& options = {}) const;

 private:
  class Snapshot;

  bool is_body(std::string_view name) const;
  std::vector<std::string> body_names() const;
  void require_free_name(const std::string& name) const;
  void require_body(std::string_view name) const;
  // That the two can collide: a body, and an obstacle or another body.
  void require_pair(std::string_view body, std::string_view other) const;
  void require_region(const Region& region) const;
  // The trees whose spheres a body consists of.
  std::vector<std::shared_ptr<const SphereTree>> trees_of(std::string_view body) const;
  void forget(std::string_view name);
  double padding_of(std::string_view body) const;
  double padding_between(std::string_view body, std::string_view other) const;
  // Whether two bodies are kept apart by more than nothing: proofs do not hold for that.
  bool is_padded(std::string_view first, std::string_view second) const;

  RobotModel robot_;
  Pose world_from_root_;
  AllowedCollisions allowed_;
  std::shared_ptr<const LinkPairs> link_pairs_;
  std::map<std::string, Obstacle, std::less<>> obstacles_;
  std::map<std::string, Attached, std::less<>> attached_;
  std::map<std::string, double, std::less<>> padding_;
  std::map<NamePair, double> pair_padding_;              // names in their order
  std::map<NamePair, std::vector<BodySphere>> regions_;  // of a body and a region, sorted
  std::set<Intended> intended_;
};

}  // namespace spherule
