// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/tree_nodes.h"

#include "base/error.h"
#include "geometry/median_split.h"
#include "geometry/sphere.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// A sphere on its way down the splits; the splits move these, not indices, to read memory in order.
struct Item {
  Vector3d center;
  double radius = 0.0;
  std::int32_t sphere = 0;
};

// An axis-aligned box.
struct Box {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Item& item) {
    low = low.cwiseMin((item.center.array() - item.radius).matrix());
    high = high.cwiseMax((item.center.array() + item.radius).matrix());
  }
  void add(const Box& box) {
    low = low.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
};

// What a half costs a query: it is opened about as often as the sphere around it is large, and then
// there are so many spheres below. The square or the volume of the sphere in place of its radius
// gave a tenth more node tests on the workload of bench/.
double cost(const Box& box, std::size_t count) {
  return (box.high - box.low).norm() * static_cast<double>(count);
}

// A way to split that is the cheapest so far.
struct Choice {
  double cost = std::numeric_limits<double>::infinity();
  Eigen::Index axis = 0;
  std::size_t below = 0;  // of the sorted items, or of the bins
};

// Splits sets of items in two, never leaving one side empty. The halves do not depend on the
// standard library: all orders are complete, by value and then by sphere; once the median has been
// used it is used for all that lies below.
class Splitter {
 public:
  explicit Splitter(std::size_t count)
      // 2 log2 n + 8, see build_tree().
      : max_cheapest_depth_(2 * static_cast<int>(std::bit_width(count - 1)) + 8) {
    scratch_.reserve(count);
  }

  // Reorders `items` and returns the size of the first half.
  std::size_t split(std::span<Item> items, int depth) {
    Box centers;
    for (const Item& item : items) centers.add(item.center);
    Eigen::Index axis = 0;
    const double extent = (centers.high - centers.low).maxCoeff(&axis);
    if (!(extent > 0.0) || depth > max_cheapest_depth_) return split_at_median(items, axis);
    return items.size() <= kSorted ? split_sorted(items) : split_binned(items, centers);
  }

 private:
  // Up to so many items are sorted along each axis and split between any two; more go into bins.
  static constexpr std::size_t kSorted = 256;
  static constexpr std::size_t kBins = 32;

  struct Key {
    double value;
    std::int32_t sphere;
    std::int32_t item;

    bool operator<(const Key& other) const {
      return value < other.value || (value == other.value && sphere < other.sphere);
    }
  };

  std::size_t split_sorted(std::span<Item> items) {
    Choice best;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::vector<Key>& keys = keys_[static_cast<std::size_t>(axis)];
      keys.clear();
      for (const Item& item : items) {
        keys.push_back({item.center[axis], item.sphere, static_cast<std::int32_t>(keys.size())});
      }
      std::sort(keys.begin(), keys.end());
      const auto at = [&](std::size_t i) -> const Item& {
        return items[static_cast<std::size_t>(keys[i].item)];
      };
      costs_above_.resize(items.size());
      Box above;
      for (std::size_t i = items.size(); i-- > 1;) {
        above.add(at(i));
        costs_above_[i] = cost(above, items.size() - i);
      }
      Box below;
      for (std::size_t i = 1; i < items.size(); ++i) {
        below.add(at(i - 1));
        const double sum = cost(below, i) + costs_above_[i];
        if (sum < best.cost) best = {sum, axis, i};
      }
    }
    scratch_.assign(items.begin(), items.end());
    const std::vector<Key>& keys = keys_[static_cast<std::size_t>(best.axis)];
    for (std::size_t i = 0; i < items.size(); ++i) {
      items[i] = scratch_[static_cast<std::size_t>(keys[i].item)];
    }
    return best.below;
  }

  // The lowest centre is in the first bin and the highest in the last.
  static std::size_t bin_of(const Item& item, const Box& centers, Eigen::Index axis) {
    const double share =
        (item.center[axis] - centers.low[axis]) / (centers.high[axis] - centers.low[axis]);
    return std::min(kBins - 1, static_cast<std::size_t>(share * static_cast<double>(kBins)));
  }

  std::size_t split_binned(std::span<Item> items, const Box& centers) {
    struct Bin {
      Box box;
      std::size_t count = 0;
    };
    Choice best;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!(centers.high[axis] > centers.low[axis])) continue;
      std::array<Bin, kBins> bins;
      for (const Item& item : items) {
        Bin& bin = bins[bin_of(item, centers, axis)];
        bin.box.add(item);
        ++bin.count;
      }
      std::array<double, kBins> costs_above;
      Bin above;
      for (std::size_t i = kBins; i-- > 1;) {
        above.box.add(bins[i].box);
        above.count += bins[i].count;
        costs_above[i] = cost(above.box, above.count);
      }
      Bin below;
      for (std::size_t i = 1; i < kBins; ++i) {
        below.box.add(bins[i - 1].box);
        below.count += bins[i - 1].count;
        const double sum = cost(below.box, below.count) + costs_above[i];
        if (sum < best.cost) best = {sum, axis, i};
      }
    }
    scratch_.clear();
    std::size_t below = 0;
    for (const Item& item : items) {
      if (bin_of(item, centers, best.axis) < best.below) {
        items[below++] = item;
      } else {
        scratch_.push_back(item);
      }
    }
    std::copy(scratch_.begin(), scratch_.end(), items.begin() + static_cast<std::ptrdiff_t>(below));
    return below;
  }

  static std::size_t split_at_median(std::span<Item> items, Eigen::Index axis) {
    return internal::split_at_median(
        items, [axis](const Item& item) { return std::pair(item.center[axis], item.sphere); });
  }

  int max_cheapest_depth_;
  std::vector<Item> scratch_;
  std::array<std::vector<Key>, 3> keys_;
  std::vector<double> costs_above_;
};

// The smallest sphere around two spheres, unpadded.
Sphere merged(const Sphere& a, const Sphere& b) {
  const Vector3d offset = b.center - a.center;
  const double distance = offset.norm();
  if (distance + b.radius <= a.radius) return a;
  if (distance + a.radius <= b.radius) return b;
  const double radius = 0.5 * (distance + a.radius + b.radius);
  return {a.center + offset * ((radius - a.radius) / distance), radius};
}

}  // namespace

std::vector<BinaryNode> binary_tree(std::span<const Sphere> spheres) {
  struct Task {
    std::int32_t node;
    int depth;
    std::size_t begin, end;
  };
  std::vector<Item> items;
  items.reserve(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    items.push_back({spheres[i].center, spheres[i].radius, static_cast<std::int32_t>(i)});
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
      node.leaf_sphere = items[task.begin].sphere;
      node.sphere = spheres[static_cast<std::size_t>(node.leaf_sphere)];
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
    nodes[i].sphere = merged(nodes[static_cast<std::size_t>(nodes[i].left)].sphere,
                             nodes[static_cast<std::size_t>(nodes[i].right)].sphere);
  }
  return nodes;
}

void require_usable(std::span<const Sphere> spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!is_usable(spheres[i])) {
      throw Error("sphere tree", "sphere " + std::to_string(i) +
                                     " is not usable: not finite, too large or of negative radius");
    }
  }
}

bool same_bits(const Sphere& a, const Sphere& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return bits(a.center.x()) == bits(b.center.x()) && bits(a.center.y()) == bits(b.center.y()) &&
         bits(a.center.z()) == bits(b.center.z()) && bits(a.radius) == bits(b.radius);
}

Sphere sphere_of(const SphereTreeData& data, std::size_t node) {
  return {{data.x[node], data.y[node], data.z[node]}, data.radius[node]};
}

void set_sphere(SphereTreeData& data, std::size_t node, const Sphere& sphere) {
  data.x[node] = sphere.center.x();
  data.y[node] = sphere.center.y();
  data.z[node] = sphere.center.z();
  data.radius[node] = sphere.radius;
}

Sphere sphere_around_children(const SphereTreeData& data, std::size_t node) {
  const auto first = static_cast<std::size_t>(data.first_child[node]);
  const auto count = static_cast<std::size_t>(data.child_count[node]);
  std::array<Sphere, SphereTree::kMaxBranching> children;
  for (std::size_t i = 0; i < count; ++i) children[i] = sphere_of(data, first + i);
  return enclosing_sphere(std::span<const Sphere>(children).first(count));
}

void check_root(const SphereTreeData& data) {
  if (!(data.radius[0] <= kMaxCoordinate)) {
    throw Error("sphere tree", "the sphere around all spheres is too large");
  }
}

WideNodes::WideNodes(std::span<const BinaryNode> nodes, int branching)
    : nodes_(nodes), branching_(branching), rows_(nodes.size(), -1) {
  std::int32_t inner = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].is_leaf()) rows_[i] = inner++;
  }
  costs_.resize(static_cast<std::size_t>(inner) * static_cast<std::size_t>(branching));
  left_slots_.resize(costs_.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    if (!nodes[i].is_leaf()) choose(static_cast<std::int32_t>(i), nodes[0].sphere.radius);
  }
}

std::size_t WideNodes::slot_index(std::int32_t node, int slots) const {
  return static_cast<std::size_t>(rows_[static_cast<std::size_t>(node)]) *
             static_cast<std::size_t>(branching_) +
         static_cast<std::size_t>(slots - 1);
}

float WideNodes::cost(std::int32_t node, int slots) const {
  return at(node).is_leaf() ? 0.0F : costs_[slot_index(node, slots)];
}

void WideNodes::choose(std::int32_t node, double largest_radius) {
  const std::int32_t left = at(node).left, right = at(node).right;
  const double size = largest_radius > 0.0 ? at(node).sphere.radius / largest_radius : 0.0;
  const auto split = [&](int slots) {
    std::pair best(std::numeric_limits<float>::infinity(), 0);
    for (int i = 1; i < slots; ++i) {
      const float sum = cost(left, i) + cost(right, slots - i);
      if (sum < best.first) best = {sum, i};
    }
    return best;
  };
  const auto put = [&](int slots, float least, int left_slots) {
    costs_[slot_index(node, slots)] = least;
    left_slots_[slot_index(node, slots)] = static_cast<std::int8_t>(left_slots);
  };
  const auto [below, own_left_slots] = split(branching_);
  const float kept = below + static_cast<float>(size * size);
  put(1, kept, own_left_slots);
  for (int slots = 2; slots <= branching_; ++slots) {
    const auto [opened, left_slots] = split(slots);
    if (kept < opened) {
      put(slots, kept, 0);
    } else {
      put(slots, opened, left_slots);
    }
  }
}

void WideNodes::collect(std::int32_t node, int slots, std::vector<std::int32_t>& children) const {
  const int left_slots =
      slots == 1 || at(node).is_leaf() ? 0 : left_slots_[slot_index(node, slots)];
  if (left_slots == 0) {
    children.push_back(node);
    return;
  }
  collect(at(node).left, left_slots, children);
  collect(at(node).right, slots - left_slots, children);
}

std::vector<std::int32_t> WideNodes::children(std::int32_t node) const {
  const int left_slots = left_slots_[slot_index(node, 1)];
  std::vector<std::int32_t> children;
  collect(at(node).left, left_slots, children);
  collect(at(node).right, branching_ - left_slots, children);
  return children;
}

}  // namespace spherule::internal
