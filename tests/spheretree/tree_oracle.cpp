// SPDX-License-Identifier: BSD-3-Clause
#include "tests/spheretree/tree_oracle.h"

#include "tests/spheretree/exact.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

Sphere sphere_of(const SphereTreeData& data, std::size_t node) {
  return {{data.x.at(node), data.y.at(node), data.z.at(node)}, data.radius.at(node)};
}

bool usable(const Sphere& s) {
  for (const double value : {s.center.x(), s.center.y(), s.center.z(), s.radius}) {
    if (!std::isfinite(value) || std::abs(value) > 1e15) return false;
  }
  return s.radius >= 0.0;
}

bool identical(const Sphere& a, const Sphere& b) {
  return std::memcmp(a.center.data(), b.center.data(), 3 * sizeof(double)) == 0 &&
         std::memcmp(&a.radius, &b.radius, sizeof(double)) == 0;
}

}  // namespace

std::string fault_of(const SphereTreeData& data) {
  const std::size_t count = data.radius.size();
  if (count == 0 || data.spheres.empty()) return "empty";
  std::vector<int> visits(count, 0);
  std::vector<int> leaves(data.spheres.size(), 0);
  std::deque<std::size_t> open = {0};
  std::size_t expected = 0;
  while (!open.empty()) {
    const std::size_t node = open.front();
    open.pop_front();
    const std::string name = "node " + std::to_string(node);
    if (node != expected++) return name + " is out of breadth-first order";
    if (++visits.at(node) > 1) return name + " is visited twice";
    const Sphere sphere = sphere_of(data, node);
    if (!usable(sphere)) return name + " is not usable";
    const auto first = data.first_child.at(node);
    const auto children = data.child_count.at(node);
    if (children == 0) {
      const auto index = static_cast<std::size_t>(first);
      if (++leaves.at(index) > 1) return name + ": the sphere has two leaves";
      if (!identical(sphere, data.spheres[index])) return name + " differs from its sphere";
      continue;
    }
    if (children < 0 || children > 16) return name + " has too many children";
    for (std::int32_t i = 0; i < children; ++i) {
      const auto child = static_cast<std::size_t>(first + i);
      if (child <= node) return name + " comes after its child";
      if (!encloses_exactly(sphere, sphere_of(data, child)))
        return name + " does not enclose a child";
      open.push_back(child);
    }
  }
  if (std::count(visits.begin(), visits.end(), 1) != static_cast<std::ptrdiff_t>(count)) {
    return "a node is not reached";
  }
  if (std::count(leaves.begin(), leaves.end(), 1) != static_cast<std::ptrdiff_t>(leaves.size())) {
    return "a sphere has no leaf";
  }
  return {};
}

int depth_of(const SphereTreeData& data) {
  int deepest = 0;
  std::vector<std::pair<std::size_t, int>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [node, depth] = open.back();
    open.pop_back();
    deepest = std::max(deepest, depth);
    for (std::int32_t i = 0; i < data.child_count[node]; ++i) {
      open.emplace_back(static_cast<std::size_t>(data.first_child[node] + i), depth + 1);
    }
  }
  return deepest;
}

}  // namespace spherule::test
