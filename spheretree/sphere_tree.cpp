// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/sphere_tree.h"

#include "base/error.h"
#include "base/rounding.h"
#include "spheretree/tree_nodes.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

namespace spherule {

SphereTree::SphereTree(SphereTreeData data) : data_(std::move(data)) {
  const TreeReport report = check(data_);
  if (!report.valid) throw Error("sphere tree", report.problems.front());
  depth_ = report.depth;
  branching_ = report.branching;
  measure();
}

void SphereTree::measure() {
  root_ = sphere(0);
  reach_ = 0.0;
  // Rounding keeps the order, so the least of the rounded numbers is the least one, rounded.
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array3d high = -low;
  for (const Sphere& sphere : data_.spheres) {
    reach_ = std::max(reach_, add_up(norm_upper(sphere.center), sphere.radius));
    low = low.min(sphere.center.array() - sphere.radius);
    high = high.max(sphere.center.array() + sphere.radius);
  }
  for (int i = 0; i < 3; ++i) {
    const double least = next_down(low[i]);
    const double most = next_up(high[i]);
    const double center = 0.5 * (least + most);
    box_.center[i] = center;
    box_.half_size[i] = std::max(sub_up(center, least), sub_up(most, center));
  }
}

std::vector<Sphere> SphereTree::level(int level) const {
  assert(level >= 0);
  std::vector<Sphere> spheres;
  // Breadth-first order: the nodes at one distance from the root are consecutive.
  std::size_t begin = 0;
  std::size_t end = 1;
  for (int distance = 0; begin < end; ++distance) {
    std::size_t next_end = end;
    for (std::size_t node = begin; node < end; ++node) {
      if (distance == level || is_leaf(node)) spheres.push_back(sphere(node));
      next_end += static_cast<std::size_t>(child_count(node));
    }
    if (distance == level) break;
    begin = end;
    end = next_end;
  }
  return spheres;
}

namespace {

// One run of check(), for G3 and G8. Nothing about the data is taken for granted: each step reads
// only what the steps before it have found in order.
class Checker {
 public:
  explicit Checker(const SphereTreeData& data) : data_(data) {}

  TreeReport run() {
    report_.sphere_count = data_.spheres.size();
    report_.node_count = data_.radius.size();
    if (check_sizes()) {
      check_numbers();
      const bool structure = check_structure();
      check_leaves();
      if (structure) {
        check_enclosure();
        measure_depth();
      }
      report_.root_radius = data_.radius[0];
    }
    report_.valid = report_.problems.empty();
    return std::move(report_);
  }

 private:
  template <typename... Parts>
  void problem(const Parts&... parts) {
    if (report_.problems.size() >= TreeReport::kMaxProblems) return;
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    (text << ... << parts);
    report_.problems.push_back(text.str());
  }

  std::size_t node_count() const { return report_.node_count; }

  Sphere sphere(std::size_t node) const { return internal::sphere_of(data_, node); }

  bool check_sizes() {
    const std::size_t n = node_count();
    if (data_.x.size() != n || data_.y.size() != n || data_.z.size() != n ||
        data_.first_child.size() != n || data_.child_count.size() != n) {
      problem("the arrays of the nodes differ in length");
    } else if (n == 0) {
      problem("there is no node");
    } else if (n > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
      problem(n, " nodes are more than 32-bit indices can name");
    }
    if (data_.spheres.empty()) problem("there is no sphere");
    return report_.problems.empty();
  }

  // Invariant 1.
  void check_numbers() {
    for (std::size_t node = 0; node < node_count(); ++node) {
      if (!is_usable(sphere(node))) problem("node ", node, ": a number is not usable");
    }
    for (std::size_t i = 0; i < data_.spheres.size(); ++i) {
      if (!is_usable(data_.spheres[i])) problem("sphere ", i, ": a number is not usable");
    }
  }

  // Invariants 2 and 5. The children of the inner nodes, in the order of their parents, must number
  // the nodes from 1 on without gap or overlap; then every node but the root has one parent.
  bool check_structure() {
    const auto n = static_cast<std::int64_t>(node_count());
    std::int64_t next = 1;
    for (std::int64_t node = 0; node < n; ++node) {
      const std::int64_t count = data_.child_count[static_cast<std::size_t>(node)];
      const std::int64_t first = data_.first_child[static_cast<std::size_t>(node)];
      if (node >= next) {
        problem("node ", node, " is the child of no node before it");
        return false;
      }
      if (count == 0) continue;
      if (count < 0 || count > SphereTree::kMaxBranching) {
        problem("node ", node, ": ", count, " children; 0 to ", SphereTree::kMaxBranching,
                " are allowed");
        return false;
      }
      report_.branching = std::max(report_.branching, static_cast<int>(count));
      if (first != next) {
        problem("node ", node, ": the first child is ", first, " where breadth-first order has ",
                next);
        return false;
      }
      next += count;
      if (next > n) {
        problem("node ", node, ": children up to ", next - 1, ", but there are only ", n, " nodes");
        return false;
      }
    }
    return true;
  }

  // Invariant 3.
  void check_leaves() {
    std::vector<bool> seen(data_.spheres.size(), false);
    for (std::size_t node = 0; node < node_count(); ++node) {
      if (data_.child_count[node] != 0) continue;
      ++report_.leaf_count;
      const std::int32_t index = data_.first_child[node];
      if (index < 0 || static_cast<std::size_t>(index) >= seen.size()) {
        problem("leaf ", node, ": sphere ", index, " does not exist");
        continue;
      }
      const auto i = static_cast<std::size_t>(index);
      if (seen[i]) problem("leaf ", node, ": sphere ", i, " has another leaf already");
      seen[i] = true;
      if (!internal::same_bits(sphere(node), data_.spheres[i])) {
        problem("leaf ", node, ": its sphere is not that of sphere ", i);
      }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!seen[i]) problem("sphere ", i, " has no leaf");
    }
  }

  // Invariant 4.
  void check_enclosure() {
    double inflation = 0.0;
    std::size_t inner_count = 0;
    for (std::size_t node = 0; node < node_count(); ++node) {
      const auto first = static_cast<std::size_t>(data_.first_child[node]);
      const auto count = static_cast<std::size_t>(data_.child_count[node]);
      if (count == 0) continue;
      const Sphere parent = sphere(node);
      double largest = 0.0;
      for (std::size_t child = first; child < first + count; ++child) {
        if (!certainly_encloses(parent, sphere(child))) {
          problem("node ", node, " of radius ", parent.radius, " does not enclose its child ",
                  child, ", which reaches ",
                  (parent.center - sphere(child).center).norm() + data_.radius[child]);
        }
        largest = std::max(largest, data_.radius[child]);
      }
      // Points (radius 0) have no growth to speak of.
      if (largest > 0.0) {
        inflation += parent.radius / largest;
        ++inner_count;
      }
    }
    if (inner_count > 0) report_.mean_inflation = inflation / static_cast<double>(inner_count);
  }

  void measure_depth() {
    std::size_t begin = 0;
    std::size_t end = 1;
    for (int depth = 0; begin < end; ++depth) {
      report_.depth = depth;
      std::size_t next_end = end;
      for (std::size_t node = begin; node < end; ++node) {
        next_end += static_cast<std::size_t>(data_.child_count[node]);
      }
      begin = end;
      end = next_end;
    }
  }

  const SphereTreeData& data_;
  TreeReport report_;
};

}  // namespace

TreeReport check(const SphereTreeData& data) {
  require_rounding_to_nearest();
  return Checker(data).run();
}

TreeReport check(const SphereTree& tree) {
  return check(tree.data());
}

}  // namespace spherule
