// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_scene.h"

#include "robot/pairs/internal/proof_scope.h"
#include "robot/pairs/link_pairs.h"
#include "spheretree/error.h"
#include "spheretree/moved_from.h"
#include "spheretree/rounding.h"
#include "spheretree/text/nearest_name.h"

#include <algorithm>
#include <cmath>

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
    internal::require_content((*tree)->node_count() > 0, "SphereTree");
  } else {
    const auto& solid = std::get<std::shared_ptr<const SolidMesh>>(shape);
    if (!solid) throw Error(name, "the mesh is missing");
    internal::require_content(solid->mesh().tree().node_count() > 0, "SolidMesh");
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
  internal::require_content(tree->node_count() > 0, "SphereTree");
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

}  // namespace spherule
