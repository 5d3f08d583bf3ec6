// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/build.h"

#include "spheretree/error.h"
#include "spheretree/internal/node_balls.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

// A tree over n spheres has at most 2 n - 1 nodes, which 32-bit indices must name.
constexpr std::size_t kMaxSpheres = std::size_t{1} << 30U;

// A sphere on its way down the splits; the splits move these, not indices, to read memory in order.
struct Item {
  Vector3d center;
  std::int32_t sphere = 0;
};

// Node of the binary tree that the splits make. Children have larger numbers than their parent.
struct BinaryNode {
  std::int32_t left = -1;  // a leaf has none
  std::int32_t right = -1;
  std::int32_t sphere = -1;  // of a leaf
  // Decides which node is opened when the tree is made wide; not part of the result.
  Sphere ball;

  bool is_leaf() const { return left < 0; }
};

struct Bounds {
  Vector3d low;
  Vector3d high;
  Vector3d mean;

  explicit Bounds(std::span<const Item> items)
      : low(items[0].center), high(items[0].center), mean(Vector3d::Zero()) {
    for (const Item& item : items) {
      low = low.cwiseMin(item.center);
      high = high.cwiseMax(item.center);
      mean += item.center;
    }
    mean /= static_cast<double>(items.size());
  }
};

// Splits sets of items in two, never leaving one side empty. The halves do not depend on the
// standard library: the partition at a value keeps the order, and the median orders ties by sphere;
// once the median has been used it is used for all that lies below, where order means nothing.
class Splitter {
 public:
  explicit Splitter(std::size_t count)
      // 2 log2 n + 8, see build_tree().
      : max_mean_depth_(2 * static_cast<int>(std::bit_width(count - 1)) + 8) {
    scratch_.reserve(count);
  }

  // Reorders `items` and returns the size of the first half.
  std::size_t split(std::span<Item> items, int depth) {
    const Bounds bounds(items);
    Eigen::Index axis = 0;
    const double extent = (bounds.high - bounds.low).maxCoeff(&axis);
    if (!(extent > 0.0) || depth > max_mean_depth_) return split_at_median(items, axis);
    const std::size_t below = split_at(items, axis, bounds.mean[axis]);
    // The mean of values a few units in the last place apart may round to the least of them or past
    // the greatest; then the greatest are split off.
    if (below == 0 || below == items.size()) return split_at(items, axis, bounds.high[axis]);
    return below;
  }

 private:
  std::size_t split_at(std::span<Item> items, Eigen::Index axis, double value) {
    scratch_.clear();
    std::size_t below = 0;
    for (const Item& item : items) {
      if (item.center[axis] < value) {
        items[below++] = item;
      } else {
        scratch_.push_back(item);
      }
    }
    std::copy(scratch_.begin(), scratch_.end(), items.begin() + static_cast<std::ptrdiff_t>(below));
    return below;
  }

  static std::size_t split_at_median(std::span<Item> items, Eigen::Index axis) {
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [axis](const Item& a, const Item& b) {
                       return std::pair(a.center[axis], a.sphere) <
                              std::pair(b.center[axis], b.sphere);
                     });
    return half;
  }

  int max_mean_depth_;
  std::vector<Item> scratch_;
};

// The smallest ball around two balls, unpadded.
Sphere merged(const Sphere& a, const Sphere& b) {
  const Vector3d offset = b.center - a.center;
  const double distance = offset.norm();
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = 0.5 * (distance + a.radius + b.radius);
  return {a.center + offset * ((radius - a.radius) / distance), radius};
}

std::vector<BinaryNode> binary_tree(std::span<const Sphere> spheres) {
  struct Task {
    std::int32_t node;
    int depth;
    std::size_t begin, end;
  };
  std::vector<Item> items;
  items.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    items.push_back({spheres[i].center, static_cast<std::int32_t>(i)});
  }
  std::vector<BinaryNode> nodes;
  nodes.reserve(2 * spheres.size() - 1);
  nodes.emplace_back();
  Splitter splitter(spheres.size());
  std::vector<Task> tasks = {{0, 0, 0, items.size()}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    BinaryNode& node = nodes[static_cast<std::size_t>(task.node)];
    if (task.end - task.begin == 1) {
      node.sphere = items[task.begin].sphere;
      node.ball = spheres[static_cast<std::size_t>(node.sphere)];
      continue;
    }
    const std::span<Item> part = std::span(items).subspan(task.begin, task.end - task.begin);
    const std::size_t middle = task.begin + splitter.split(part, task.depth);
    node.left = static_cast<std::int32_t>(nodes.size());
    node.right = node.left + 1;
    tasks.push_back({node.right, task.depth + 1, middle, task.end});
    tasks.push_back({node.left, task.depth + 1, task.begin, middle});
    nodes.resize(nodes.size() + 2);
  }
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].is_leaf()) continue;
    nodes[i].ball = merged(nodes[static_cast<std::size_t>(nodes[i].left)].ball,
                           nodes[static_cast<std::size_t>(nodes[i].right)].ball);
  }
  return nodes;
}

// The children of the wide node made from `node`, in the order of the splits: the largest is opened
// until there are `branching` of them or only leaves.
std::vector<std::int32_t> wide_children(const std::vector<BinaryNode>& nodes, std::int32_t node,
                                        std::size_t branching) {
  const auto at = [&nodes](std::int32_t i) -> const BinaryNode& {
    return nodes[static_cast<std::size_t>(i)];
  };
  std::vector<std::int32_t> children = {at(node).left, at(node).right};
  while (children.size() < branching) {
    auto largest = children.end();
    for (auto child = children.begin(); child != children.end(); ++child) {
      if (at(*child).is_leaf()) continue;
      if (largest == children.end() || at(*child).ball.radius > at(*largest).ball.radius) {
        largest = child;
      }
    }
    if (largest == children.end()) break;
    const BinaryNode& opened = at(*largest);
    *largest = opened.left;
    children.insert(largest + 1, opened.right);
  }
  return children;
}

// Lays out the wide nodes breadth-first. Balls of inner nodes are left to fit_balls().
SphereTreeData lay_out(const std::vector<BinaryNode>& nodes, std::span<const Sphere> spheres,
                       int branching) {
  SphereTreeData data;
  data.spheres.assign(spheres.begin(), spheres.end());
  std::vector<std::int32_t> sources = {0};
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const BinaryNode& node = nodes[static_cast<std::size_t>(sources[i])];
    if (node.is_leaf()) {
      data.first_child.push_back(node.sphere);
      data.child_count.push_back(0);
      continue;
    }
    const std::vector<std::int32_t> children =
        wide_children(nodes, sources[i], static_cast<std::size_t>(branching));
    data.first_child.push_back(static_cast<std::int32_t>(sources.size()));
    data.child_count.push_back(static_cast<std::int32_t>(children.size()));
    sources.insert(sources.end(), children.begin(), children.end());
  }
  return data;
}

// From the last node to the first, so that the children's balls are there before the parent's.
void fit_balls(SphereTreeData& data) {
  const std::size_t count = data.child_count.size();
  for (auto* array : {&data.x, &data.y, &data.z, &data.radius}) array->resize(count);
  for (std::size_t node = count; node-- > 0;) {
    internal::set_ball(data, node,
                       data.child_count[node] == 0
                           ? data.spheres[static_cast<std::size_t>(data.first_child[node])]
                           : internal::ball_around_children(data, node));
  }
}

void check_input(std::span<const Sphere> spheres, const BuildOptions& options) {
  if (options.branching < 2 || options.branching > SphereTree::kMaxBranching) {
    throw Error("branching", std::to_string(options.branching) + " is not between 2 and " +
                                 std::to_string(SphereTree::kMaxBranching));
  }
  if (spheres.empty()) throw Error("sphere tree", "there is no sphere");
  if (spheres.size() > kMaxSpheres) {
    throw Error("sphere tree", std::to_string(spheres.size()) + " spheres are too many");
  }
  internal::require_usable(spheres);
}

}  // namespace

SphereTree build_tree(std::span<const Sphere> spheres, const BuildOptions& options) {
  check_input(spheres, options);
  SphereTreeData data = lay_out(binary_tree(spheres), spheres, options.branching);
  fit_balls(data);
  internal::check_root(data);
  return SphereTree(std::move(data));
}

}  // namespace spherule
