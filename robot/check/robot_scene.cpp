// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_scene.h"

#include "base/error.h"
#include "base/rounding.h"
#include "base/text.h"
#include "collide/meshes/mesh_contact.h"
#include "robot/check/checker_parts.h"
#include "robot/model/link_paths.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/proof_scope.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace spherule {
namespace {

void require_padding(double padding, std::string_view name) {
  if (!(padding >= 0.0 && padding <= kMaxCoordinate)) {
    throw Error("padding of " + std::string(name), "it is not a number from 0 to 1e15");
  }
}

std::pair<std::string, std::string> in_order(std::string_view first, std::string_view second) {
  return {std::string(std::min(first, second)), std::string(std::max(first, second))};
}

template <class Map>
std::vector<std::string> names_in(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

// What has that name among the obstacles or the attached objects.
template <class Map>
auto found_in(Map& map, std::string_view name, const char* kind) {
  const auto found = map.find(name);
  if (found == map.end()) {
    throw Error(std::string(name), "there is no " + std::string(kind) + " of that name");
  }
  return found;
}

}  // namespace

RobotScene::RobotScene(RobotModel robot, const Pose& world_from_root)
    : robot_(std::move(robot)),
      world_from_root_(unit_rotation(world_from_root.rotation()), world_from_root.translation()),
      allowed_(robot_) {}

void RobotScene::set_allowed_collisions(AllowedCollisions allowed) {
  allowed.require_robot(robot_);
  const AllowedCollisions own(robot_);
  for (const auto& [first, second, reason] : allowed.pairs()) {
    const bool is_by_structure =
        reason == AllowedReason::kRigid || reason == AllowedReason::kAdjacent;
    if (!is_by_structure || own.allows(first, second)) continue;
    const auto& names = own.link_names();
    allowed.forbid(names[static_cast<std::size_t>(first)], names[static_cast<std::size_t>(second)]);
  }
  allowed_ = std::move(allowed);
}

bool RobotScene::is_body(std::string_view name) const {
  return robot_.find_link(name) >= 0 || attached_.find(name) != attached_.end();
}

std::vector<std::string> RobotScene::body_names() const {
  std::vector<std::string> names = names_in(attached_);
  for (const Link& link : robot_.links()) names.push_back(link.name);
  return names;
}

void RobotScene::require_free_name(const std::string& name) const {
  if (name.empty()) throw Error("scene", "a name is empty");
  if (is_body(name) || obstacles_.find(name) != obstacles_.end()) {
    throw Error(name, "a link, an attached object or an obstacle has that name already");
  }
}

void RobotScene::require_body(std::string_view name) const {
  if (!is_body(name)) {
    throw Error(std::string(name), "there is no link or attached object of that name" +
                                       internal::did_you_mean(name, body_names()));
  }
}

void RobotScene::require_pair(std::string_view body, std::string_view other) const {
  require_body(body);
  if (body == other) throw Error(std::string(body), "it cannot collide with itself");
  if (!is_body(other) && obstacles_.find(other) == obstacles_.end()) {
    std::vector<std::string> names = body_names();
    for (const std::string& name : obstacles()) names.push_back(name);
    throw Error(std::string(other), "there is no link, attached object or obstacle of that name" +
                                        internal::did_you_mean(other, names));
  }
}

void RobotScene::require_region(const Region& region) const {
  if (regions_.find({region.body, region.name}) == regions_.end()) {
    throw Error(region.body, "it has no region " + region.name);
  }
}

void RobotScene::add(std::string name, ObstacleShape shape, const Pose& world_from_shape) {
  require_free_name(name);
  if (const Primitive* primitive = std::get_if<Primitive>(&shape)) {
    require_primitive(*primitive, name);
  } else if (const auto* tree = std::get_if<std::shared_ptr<const SphereTree>>(&shape)) {
    if (!*tree) throw Error(name, "the tree is missing");
  } else {
    const auto& solid = std::get<std::shared_ptr<const SolidMesh>>(shape);
    if (!solid) throw Error(name, "the mesh is missing");
  }
  obstacles_.emplace(std::move(name), Obstacle{std::move(shape), world_from_shape});
}

void RobotScene::move(std::string_view obstacle, const Pose& world_from_shape) {
  found_in(obstacles_, obstacle, "obstacle")->second.world_from_shape = world_from_shape;
}

void RobotScene::remove(std::string_view obstacle) {
  const auto found = found_in(obstacles_, obstacle, "obstacle");
  forget(obstacle);
  obstacles_.erase(found);
}

const RobotScene::Obstacle& RobotScene::obstacle(std::string_view name) const {
  return found_in(obstacles_, name, "obstacle")->second;
}

const RobotScene::Attached& RobotScene::attached(std::string_view name) const {
  return found_in(attached_, name, "attached object")->second;
}

std::vector<std::string> RobotScene::obstacles() const {
  return names_in(obstacles_);
}

void RobotScene::attach(std::string name, std::string_view link,
                        std::shared_ptr<const SphereTree> tree, const Pose& link_from_object) {
  require_free_name(name);
  robot_.require_link(link);
  if (!tree) throw Error(name, "the tree is missing");
  attached_.emplace(std::move(name),
                    Attached{std::string(link), std::move(tree), link_from_object});
}

void RobotScene::detach(std::string_view object) {
  const auto found = found_in(attached_, object, "attached object");
  forget(object);
  attached_.erase(found);
}

void RobotScene::set_link_pairs(std::shared_ptr<const LinkPairs> pairs) {
  if (pairs != nullptr) internal::require_proofs_of(*pairs, robot_);
  link_pairs_ = std::move(pairs);
}

void RobotScene::set_attached_pairs(std::string_view object,
                                    std::shared_ptr<const LinkPairs> pairs) {
  const auto found = found_in(attached_, object, "attached object");
  if (pairs != nullptr) {
    internal::require_proofs_of(*pairs, robot_, robot_.find_link(found->second.link));
  }
  found->second.pairs = std::move(pairs);
}

AllowedReason RobotScene::reason(std::string_view first, std::string_view second) const {
  for (const std::string_view name : {first, second}) {
    if (robot_.find_link(name) < 0) throw Error(std::string(name), "there is no link of that name");
  }
  const int a = robot_.find_link(first);
  const int b = robot_.find_link(second);
  if (allowed_.allows(a, b) || link_pairs_ == nullptr) return allowed_.reason(a, b);
  const LinkPair* const pair = link_pairs_->find(a, b);
  if (pair == nullptr || !pair->boxes.has_free_box() || is_padded(first, second)) {
    return AllowedReason::kTested;
  }
  return pair->verdict == PairVerdict::kNever ? AllowedReason::kProvedNever
                                              : AllowedReason::kFreeInBoxes;
}

std::vector<std::string> RobotScene::attached() const {
  return names_in(attached_);
}

// `name` may be a part of what is erased.
void RobotScene::forget(std::string_view name) {
  const std::string gone(name);
  padding_.erase(gone);
  std::erase_if(pair_padding_, [&](const auto& entry) {
    return entry.first.first == gone || entry.first.second == gone;
  });
  std::erase_if(regions_, [&](const auto& entry) { return entry.first.first == gone; });
  std::erase_if(intended_, [&](const Intended& contact) {
    return contact.body == gone || contact.other == gone;
  });
}

void RobotScene::set_padding(std::string_view body, double padding) {
  require_body(body);
  require_padding(padding, body);
  padding_.insert_or_assign(std::string(body), padding);
}

void RobotScene::set_padding(std::string_view body, std::string_view other, double padding) {
  require_pair(body, other);
  require_padding(padding, body);
  pair_padding_.insert_or_assign(in_order(body, other), padding);
}

double RobotScene::padding_of(std::string_view body) const {
  const auto found = padding_.find(body);
  return found == padding_.end() ? 0.0 : found->second;
}

double RobotScene::padding_between(std::string_view body, std::string_view other) const {
  const auto found = pair_padding_.find(in_order(body, other));
  return found == pair_padding_.end() ? 0.0 : found->second;
}

bool RobotScene::is_padded(std::string_view first, std::string_view second) const {
  return padding_of(first) > 0.0 || padding_of(second) > 0.0 ||
         padding_between(first, second) > 0.0;
}

std::vector<std::shared_ptr<const SphereTree>> RobotScene::trees_of(std::string_view body) const {
  const auto object = attached_.find(body);
  if (object != attached_.end()) return {object->second.tree};
  return robot_.links()[static_cast<std::size_t>(robot_.find_link(body))].trees;
}

void RobotScene::define_region(Region region, std::span<const BodySphere> spheres) {
  require_body(region.body);
  const std::string subject = region.body + ": region " + region.name;
  if (region.name.empty()) throw Error(region.body, "the name of a region is empty");
  if (spheres.empty()) throw Error(subject, "it has no spheres");
  const auto trees = trees_of(region.body);
  for (const BodySphere& sphere : spheres) {
    if (sphere.tree >= trees.size() || sphere.sphere < 0 ||
        static_cast<std::size_t>(sphere.sphere) >= trees[sphere.tree]->spheres().size()) {
      throw Error(subject, "there is no sphere " + std::to_string(sphere.sphere) + " of tree " +
                               std::to_string(sphere.tree));
    }
  }
  std::vector<BodySphere> sorted(spheres.begin(), spheres.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::size_t all = sorted.size();
  for (const auto& [names, named] : regions_) all += named.size();
  if (all > kMostRegionSpheres)
    throw Error(subject, "the regions of the scene have too many spheres");
  regions_.insert_or_assign({std::move(region.body), std::move(region.name)}, std::move(sorted));
}

void RobotScene::define_region(Region region, const Sphere& around) {
  require_body(region.body);
  if (!is_usable(around)) throw Error(region.body, "the sphere around a region cannot be used");
  std::vector<BodySphere> inside;
  const auto trees = trees_of(region.body);
  for (std::size_t tree = 0; tree < trees.size(); ++tree) {
    const auto spheres = trees[tree]->spheres();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      if ((spheres[i].center - around.center).norm() <= around.radius) {
        inside.push_back({tree, static_cast<std::int32_t>(i)});
      }
    }
  }
  define_region(std::move(region), inside);
}

void RobotScene::allow_contact(std::string_view body, std::string_view other) {
  require_pair(body, other);
  intended_.insert({std::string(body), "", std::string(other)});
}

void RobotScene::allow_contact(const Region& region, std::string_view other) {
  require_pair(region.body, other);
  require_region(region);
  intended_.insert({region.body, region.name, std::string(other)});
}

void RobotScene::forbid_contact(std::string_view body, std::string_view other) {
  require_pair(body, other);
  intended_.erase({std::string(body), "", std::string(other)});
  intended_.erase({std::string(other), "", std::string(body)});
}

void RobotScene::forbid_contact(const Region& region, std::string_view other) {
  require_pair(region.body, other);
  require_region(region);
  intended_.erase({region.body, region.name, std::string(other)});
}

namespace {

using Tree = std::shared_ptr<const SphereTree>;

std::vector<Sphere> inflated(std::span<const Sphere> spheres, double padding) {
  std::vector<Sphere> result(spheres.begin(), spheres.end());
  if (padding == 0.0) return result;
  for (Sphere& sphere : result) sphere.radius = add_up(sphere.radius, padding);
  return result;
}

std::string unused_name(const RobotModel& robot, std::string name) {
  while (robot.find_link(name) >= 0) name += '\'';
  return name;
}

// A link that stands still in another one.
int add_fixed_link(RobotModel& robot, const std::string& name, int parent,
                   const Pose& parent_from_link) {
  const std::string parent_name = robot.links()[static_cast<std::size_t>(parent)].name;
  return robot.add_link(unused_name(robot, name), parent_name,
                        {.type = JointType::kFixed, .parent_from_joint = parent_from_link});
}

}  // namespace

// Sorts out what is tested against what.
//
// `carrier_` is the robot with a link more for each attached object.
class RobotScene::Snapshot {
 public:
  Snapshot(const RobotScene& scene, const RobotCheckerOptions& options)
      : scene_(scene), options_(options), carrier_(scene.robot_) {
    for (std::size_t i = 0; i < scene_.robot_.links().size(); ++i) {
      const Link& link = scene_.robot_.links()[i];
      bodies_.push_back({CheckedBody::Kind::kLink, link.name, static_cast<int>(i),
                         static_cast<int>(i), link.trees});
    }
    for (const auto& [name, object] : scene_.attached_) {
      const int parent = scene_.robot_.find_link(object.link);
      const int link = add_fixed_link(carrier_, name, parent, object.link_from_object);
      bodies_.push_back({CheckedBody::Kind::kAttached, name, link, parent, {object.tree}});
    }
    for (const auto& [name, obstacle] : scene_.obstacles_) {
      obstacle_names_.push_back({CheckedBody::Kind::kObstacle, name});
      const Tree* const tree = std::get_if<Tree>(&obstacle.shape);
      shapes_.push_back(
          {obstacle.shape, obstacle.world_from_shape, tree != nullptr ? mesh_of(**tree) : nullptr});
    }
  }

  std::shared_ptr<const RobotChecker::Parts> parts() {
    // What is at the end of the chain usually touches.
    for (std::size_t body = bodies_.size(); body-- > 0;) {
      for (std::size_t i = 0; i < shapes_.size(); ++i) pair_with_obstacle(body, i);
      for (std::size_t other = body; other-- > 0;) pair_bodies(body, other);
    }
    std::vector<RobotChecker::Parts::Named> names;
    for (const Body& body : bodies_) names.push_back({body.kind, body.name});
    const std::size_t static_tree_pairs_begin = pairs_.size();
    pairs_.insert(pairs_.end(), static_pairs_.begin(), static_pairs_.end());
    return std::make_shared<const RobotChecker::Parts>(
        scene_.robot_, options_,
        internal::BodyPairs(carrier_, scene_.world_from_root_, std::move(pieces_),
                            std::move(shapes_), std::move(pairs_), static_tree_pairs_begin),
        std::move(names), std::move(obstacle_names_));
  }

 private:
  struct Body {
    CheckedBody::Kind kind;
    std::string name;
    int link;         // of carrier_
    int proved_link;  // of the robot: for which it stands in proofs of pairs
    std::vector<Tree> trees;
  };

  using Regions = std::vector<std::string>;

  // The names of the regions of a body that may touch another; none if all of it may.
  std::optional<Regions> regions_left_out(const std::string& body, const std::string& other) const {
    const std::set<Intended>& contacts = scene_.intended_;
    if (contacts.contains({body, "", other}) || contacts.contains({other, "", body})) {
      return std::nullopt;
    }
    Regions regions;
    for (auto contact = contacts.lower_bound({body, "", ""});
         contact != contacts.end() && contact->body == body; ++contact) {
      if (contact->other == other) regions.push_back(contact->region);
    }
    return regions;
  }

  std::shared_ptr<const CoveredMesh> mesh_of(const SphereTree& tree) const {
    const auto found = std::find_if(options_.meshes.begin(), options_.meshes.end(),
                                    [&](const auto& mesh) { return &mesh->cover() == &tree; });
    return found == options_.meshes.end() ? nullptr : *found;
  }

  // The pieces of a body, made when they are requested first. None where no sphere is left.
  std::vector<int> pieces_of(std::size_t body, const Regions& left_out, double padding) {
    std::vector<int> result;
    for (std::size_t tree = 0; tree < bodies_[body].trees.size(); ++tree) {
      const auto [found, is_new] = known_.try_emplace({body, tree, left_out, padding}, -1);
      if (is_new) found->second = make_piece(body, tree, left_out, padding);
      if (found->second >= 0) result.push_back(found->second);
    }
    return result;
  }

  int make_piece(std::size_t body, std::size_t index, const Regions& left_out, double padding) {
    const Tree& tree = bodies_[body].trees[index];
    std::vector<bool> is_left_out(tree->spheres().size(), false);
    for (const std::string& region : left_out) {
      for (const BodySphere& sphere : scene_.regions_.at({bodies_[body].name, region})) {
        if (sphere.tree == index) is_left_out[static_cast<std::size_t>(sphere.sphere)] = true;
      }
    }
    internal::CheckedPiece piece{tree, bodies_[body].link, body, index, {}, padding, nullptr};
    if (!left_out.empty() || padding > 0.0) {
      copied_ += tree->node_count();
      if (copied_ > kMostCopiedNodes) {
        throw Error(bodies_[body].name,
                    "its paddings and regions make too many copies of its spheres");
      }
    }
    if (std::find(is_left_out.begin(), is_left_out.end(), true) != is_left_out.end()) {
      std::vector<Sphere> spheres;
      for (std::size_t i = 0; i < is_left_out.size(); ++i) {
        if (is_left_out[i]) continue;
        spheres.push_back(tree->spheres()[i]);
        piece.spheres.push_back(static_cast<std::int32_t>(i));
      }
      if (spheres.empty()) return -1;
      piece.tree = std::make_shared<const SphereTree>(build_tree(inflated(spheres, padding)));
    } else {
      piece.mesh = mesh_of(*tree);
      if (padding > 0.0) {
        piece.tree =
            std::make_shared<const SphereTree>(refit(*tree, inflated(tree->spheres(), padding)));
      }
    }
    pieces_.push_back(std::move(piece));
    return static_cast<int>(pieces_.size()) - 1;
  }

  void pair_with_obstacle(std::size_t body, std::size_t obstacle) {
    const std::string& name = bodies_[body].name;
    const std::string& other = obstacle_names_[obstacle].name;
    const std::optional<Regions> left_out = regions_left_out(name, other);
    if (!left_out) return;
    for (const int piece :
         pieces_of(body, *left_out,
                   sum_up(scene_.padding_of(name), scene_.padding_between(name, other)))) {
      const bool is_static = std::holds_alternative<Tree>(shapes_[obstacle].shape);
      require(++with_obstacles_ <= kMostObstaclePairs, "of bodies and obstacles");
      (is_static ? static_pairs_ : pairs_).push_back({piece, static_cast<int>(obstacle), true});
    }
  }

  void pair_bodies(std::size_t body, std::size_t other) {
    const Body& first = bodies_[body];
    const Body& second = bodies_[other];
    if (is_never_tested(first, second)) return;
    const std::optional<Regions> of_first = regions_left_out(first.name, second.name);
    const std::optional<Regions> of_second = regions_left_out(second.name, first.name);
    if (!of_first || !of_second) return;
    const double between = scene_.padding_between(first.name, second.name);
    const std::shared_ptr<const FreeBoxes> boxes = boxes_of(first, second);
    const std::vector<int> seconds = pieces_of(other, *of_second, scene_.padding_of(second.name));
    const double padding = sum_up(scene_.padding_of(first.name), between);
    for (const int a : pieces_of(body, *of_first, padding)) {
      for (const int b : seconds) {
        require(++of_bodies_ <= kMostBodyPairs, "of bodies");
        pairs_.push_back({a, b, false, boxes});
      }
    }
  }

  static void require(bool are_few, const char* pairs) {
    if (!are_few) throw Error("robot checker", std::string("too many pairs ") + pairs + " to test");
  }

  // Where two bodies are proved free: without padding, which the proofs do not know of.
  std::shared_ptr<const FreeBoxes> boxes_of(const Body& first, const Body& second) const {
    std::shared_ptr<const LinkPairs> pairs = scene_.link_pairs_;
    for (const Body* const body : {&first, &second}) {
      if (body->kind == CheckedBody::Kind::kAttached) {
        pairs = scene_.attached_.find(body->name)->second.pairs;
      }
    }
    const bool are_both_attached =
        first.kind == CheckedBody::Kind::kAttached && second.kind == CheckedBody::Kind::kAttached;
    if (pairs == nullptr || are_both_attached || scene_.is_padded(first.name, second.name)) {
      return nullptr;
    }
    const LinkPair* const pair = pairs->find(first.proved_link, second.proved_link);
    if (pair == nullptr || !pair->boxes.has_free_box()) return nullptr;
    return {pairs, &pair->boxes};
  }

  bool is_never_tested(const Body& first, const Body& second) const {
    if (first.kind == CheckedBody::Kind::kLink && second.kind == CheckedBody::Kind::kLink) {
      return scene_.allowed_.allows(first.link, second.link);
    }
    return internal::moving_joints(carrier_, first.link, second.link).empty();
  }

  const RobotScene& scene_;
  const RobotCheckerOptions& options_;
  RobotModel carrier_;
  std::vector<Body> bodies_;
  std::vector<RobotChecker::Parts::Named> obstacle_names_;
  std::vector<internal::PlacedShape> shapes_;
  std::map<std::tuple<std::size_t, std::size_t, Regions, double>, int> known_;
  std::vector<internal::CheckedPiece> pieces_;
  std::vector<internal::CheckedPair> pairs_;
  std::vector<internal::CheckedPair> static_pairs_;
  std::size_t of_bodies_ = 0;       // pairs so far
  std::size_t with_obstacles_ = 0;  // pairs so far
  std::size_t copied_ = 0;          // nodes of trees that are other ones with padding or regions
};

RobotChecker RobotScene::snapshot(const RobotCheckerOptions& options) const {
  if (std::find(options.meshes.begin(), options.meshes.end(), nullptr) != options.meshes.end()) {
    throw Error("robot checker", "a mesh is missing");
  }
  return RobotChecker(Snapshot(*this, options).parts());
}

}  // namespace spherule
