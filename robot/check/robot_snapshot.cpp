// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mesh_contact.h"
#include "robot/check/internal/checker_parts.h"
#include "robot/check/robot_scene.h"
#include "robot/model/internal/link_paths.h"
#include "robot/pairs/link_pairs.h"
#include "spheretree/build.h"
#include "spheretree/error.h"
#include "spheretree/moved_from.h"
#include "spheretree/refit.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <tuple>

namespace spherule {
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
  internal::require_content(!robot_.links().empty(), "RobotScene");
  if (std::find(options.meshes.begin(), options.meshes.end(), nullptr) != options.meshes.end()) {
    throw Error("robot checker", "a mesh is missing");
  }
  return RobotChecker(Snapshot(*this, options).parts());
}

}  // namespace spherule
