// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "spheretree/sphere_tree.h"

#include <queue>
#include <string>
#include <utility>

namespace spherule {
namespace {

std::string name_of(std::size_t level, std::size_t sphere) {
  return "level " + std::to_string(level) + ", sphere " + std::to_string(sphere);
}

// For every sphere of the level its children, in their order.
std::vector<std::vector<std::int32_t>> children_of(std::size_t number, const SphereLevel& level,
                                                   std::span<const Sphere> finer) {
  if (level.parent_of.size() != finer.size()) {
    throw Error("level " + std::to_string(number), std::to_string(level.parent_of.size()) +
                                                       " parents for " +
                                                       std::to_string(finer.size()) + " spheres");
  }
  std::vector<std::vector<std::int32_t>> children(level.spheres.size());
  for (std::size_t i = 0; i < finer.size(); ++i) {
    const std::int32_t parent = level.parent_of[i];
    if (parent < 0 || static_cast<std::size_t>(parent) >= children.size()) {
      throw Error("level " + std::to_string(number), "parent " + std::to_string(parent) +
                                                         " of sphere " + std::to_string(i) +
                                                         " does not exist");
    }
    children[static_cast<std::size_t>(parent)].push_back(static_cast<std::int32_t>(i));
  }
  for (std::size_t sphere = 0; sphere < children.size(); ++sphere) {
    if (children[sphere].empty()) throw Error(name_of(number, sphere), "has no children");
  }
  return children;
}

// The tree on its way from the root down; children have larger numbers than their parent.
class Builder {
 public:
  Builder(std::span<const Sphere> spheres, std::span<const SphereLevel> levels,
          const BuildOptions& options)
      : spheres_(spheres), levels_(levels), options_(options) {
    for (std::size_t k = 0; k < levels.size(); ++k) {
      children_.push_back(children_of(k, levels[k], finer_than(k)));
      nodes_of_.emplace_back(levels[k].spheres.size(), -1);
    }
  }

  LevelTree run() {
    const std::span<const Sphere> top = finer_than(levels_.size());
    nodes_.emplace_back();
    const SphereTree above = build_tree(top, options_);
    std::vector<std::int32_t> all(top.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::int32_t>(i);
    nodes_[0].sphere = above.sphere(0);
    graft(above, 0, 0, all, levels_.size());
    return lay_out();
  }

 private:
  struct Node {
    Sphere sphere;
    std::vector<std::size_t> children;
    std::int32_t leaf_sphere = -1;  // its index, of a leaf
  };

  // The spheres that are the children of level k.
  std::span<const Sphere> finer_than(std::size_t k) const {
    return k == 0 ? spheres_ : std::span<const Sphere>(levels_[k - 1].spheres);
  }

  // Makes `node` sphere `i` of those that are the children of level k, with all that is below it.
  void place(std::size_t node, std::size_t i, std::size_t k) {
    nodes_[node].sphere = finer_than(k)[i];
    if (k == 0) {
      nodes_[node].leaf_sphere = static_cast<std::int32_t>(i);
      return;
    }
    nodes_of_[k - 1][i] = static_cast<std::int32_t>(node);
    const std::vector<std::int32_t>& children = children_[k - 1][i];
    const std::span<const Sphere> finer = finer_than(k - 1);
    const auto only = static_cast<std::size_t>(children.front());
    if (children.size() == 1 && finer[only] == nodes_[node].sphere) {
      place(node, only, k - 1);
      return;
    }
    std::vector<Sphere> spheres;
    for (const std::int32_t child : children) {
      spheres.push_back(finer[static_cast<std::size_t>(child)]);
      if (!has_reserve(nodes_[node].sphere, spheres.back())) {
        throw Error(name_of(k - 1, i), "does not enclose sphere " + std::to_string(child) +
                                           " of the next finer level with the reserve");
      }
    }
    if (children.size() == 1) {
      const std::size_t child = append(node);
      place(child, only, k - 1);
      return;
    }
    graft(build_tree(spheres, options_), 0, node, children, k - 1);
  }

  static bool has_reserve(const Sphere& parent, const Sphere& child) {
    const double reach = add_up(distance_upper(parent.center, child.center), child.radius);
    return reach <= parent.radius - SphereLevel::kReserve / 2.0 * parent.radius;
  }

  // Hangs what is below node `from` of `tree` under `node`; the leaves of the tree are the spheres
  // `which` of those that are the children of level k.
  void graft(const SphereTree& tree, std::size_t from, std::size_t node,
             const std::vector<std::int32_t>& which, std::size_t k) {
    if (tree.is_leaf(from)) {
      const auto leaf = static_cast<std::size_t>(tree.sphere_index(from));
      place(node, static_cast<std::size_t>(which[leaf]), k);
      return;
    }
    const auto first = static_cast<std::size_t>(tree.first_child(from));
    const auto count = static_cast<std::size_t>(tree.child_count(from));
    for (std::size_t child = first; child < first + count; ++child) {
      const std::size_t made = append(node);
      const Sphere parent = nodes_[node].sphere;
      nodes_[made].sphere = tree.sphere(child);
      if (!tree.is_leaf(child) && !certainly_encloses(parent, nodes_[made].sphere)) {
        nodes_[made].sphere = {parent.center, next_down(parent.radius)};
      }
      graft(tree, child, made, which, k);
    }
  }

  std::size_t append(std::size_t parent) {
    nodes_[parent].children.push_back(nodes_.size());
    nodes_.emplace_back();
    return nodes_.size() - 1;
  }

  LevelTree lay_out() {
    SphereTreeData data;
    data.spheres.assign(spheres_.begin(), spheres_.end());
    std::vector<std::size_t> order = {0};
    std::vector<std::int32_t> number(nodes_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Node& node = nodes_[order[i]];
      number[order[i]] = static_cast<std::int32_t>(i);
      data.x.push_back(node.sphere.center.x());
      data.y.push_back(node.sphere.center.y());
      data.z.push_back(node.sphere.center.z());
      data.radius.push_back(node.sphere.radius);
      data.first_child.push_back(node.children.empty() ? node.leaf_sphere
                                                       : static_cast<std::int32_t>(order.size()));
      data.child_count.push_back(static_cast<std::int32_t>(node.children.size()));
      order.insert(order.end(), node.children.begin(), node.children.end());
    }
    for (std::vector<std::int32_t>& level : nodes_of_) {
      for (std::int32_t& node : level) node = number[static_cast<std::size_t>(node)];
    }
    return {SphereTree(std::move(data)), std::move(nodes_of_)};
  }

  std::span<const Sphere> spheres_;
  std::span<const SphereLevel> levels_;
  const BuildOptions& options_;
  std::vector<std::vector<std::vector<std::int32_t>>> children_;  // of every sphere of every level
  std::vector<Node> nodes_;
  std::vector<std::vector<std::int32_t>> nodes_of_;
};

}  // namespace

LevelTree build_tree_from_levels(std::span<const Sphere> spheres,
                                 std::span<const SphereLevel> levels, const BuildOptions& options) {
  return Builder(spheres, levels, options).run();
}

std::vector<Sphere> cut(const SphereTree& tree, std::size_t count) {
  // The largest sphere first, of equals the first node.
  using Entry = std::pair<double, std::int64_t>;
  std::priority_queue<Entry> open;
  std::vector<Sphere> spheres;
  const auto enter = [&](std::size_t node) {
    if (tree.is_leaf(node)) {
      spheres.push_back(tree.sphere(node));
    } else {
      open.emplace(tree.sphere(node).radius, -static_cast<std::int64_t>(node));
    }
  };
  enter(0);
  while (!open.empty()) {
    const auto node = static_cast<std::size_t>(-open.top().second);
    open.pop();
    const auto children = static_cast<std::size_t>(tree.child_count(node));
    if (spheres.size() + open.size() + children > count) {
      spheres.push_back(tree.sphere(node));
      continue;
    }
    for (std::size_t i = 0; i < children; ++i) {
      enter(static_cast<std::size_t>(tree.first_child(node)) + i);
    }
  }
  return spheres;
}

}  // namespace spherule
