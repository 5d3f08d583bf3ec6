// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shells/closed_shells.h"

#include "mesh/geometry/raw_mesh.h"
#include "mesh/geometry/solid_angle.h"
#include "mesh/shells/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>

namespace spherule::internal {
namespace {

// An edge of a triangle; it runs from `low` to `high` or back.
struct EdgeUse {
  int low, high;
  std::uint32_t triangle;
  bool forward;

  bool is_along(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

// Sorted by edge. A triangle with a repeated corner runs along an edge and back: it has no winding
// number and is left out.
std::vector<EdgeUse> edge_uses(const TriangleMesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (int k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      uses.push_back(
          {std::min(from, to), std::max(from, to), static_cast<std::uint32_t>(i), from < to});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.low < b.low || (a.low == b.low && a.high < b.high);
  });
  return uses;
}

}  // namespace

ClosedShells::ClosedShells(const TriangleMesh& input) {
  const TriangleMesh mesh = weld(input);
  const std::vector<EdgeUse> uses = edge_uses(mesh);
  DisjointSets parts(mesh.triangles.size());
  std::vector<std::uint32_t> unbalanced;  // a triangle at each such edge
  for (std::size_t i = 0; i < uses.size();) {
    const EdgeUse& first = uses[i];
    int balance = 0;
    for (; i < uses.size() && uses[i].is_along(first); ++i) {
      parts.unite(first.triangle, uses[i].triangle);
      balance += uses[i].forward ? 1 : -1;
    }
    if (balance != 0) unbalanced.push_back(first.triangle);
  }
  std::vector<char> is_open(mesh.triangles.size(), 0);  // of the roots
  for (const std::uint32_t triangle : unbalanced) is_open[parts.find(triangle)] = 1;

  std::map<std::uint32_t, std::size_t> shell_of;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t root = parts.find(static_cast<std::uint32_t>(i));
    if (is_open[root] != 0) continue;
    const auto [entry, is_new] = shell_of.try_emplace(root, shells_.size());
    if (is_new) shells_.emplace_back();
    Shell& shell = shells_[entry->second];
    std::array<Eigen::Vector3d, 3>& corners = shell.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][static_cast<int>(k)])];
      shell.box.extend(corners[k]);
    }
  }
}

bool ClosedShells::contain(const Eigen::Vector3d& point) const {
  return std::any_of(shells_.begin(), shells_.end(), [&](const Shell& shell) {
    if (!shell.box.contains(point)) return false;
    double angle = 0.0;
    for (const auto& [a, b, c] : shell.triangles) {
      angle += solid_angle(a - point, b - point, c - point);
    }
    return std::abs(angle) > 2.0 * std::numbers::pi;
  });
}

}  // namespace spherule::internal
