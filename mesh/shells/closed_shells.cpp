// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shells/closed_shells.h"

#include "mesh/geometry/raw_mesh.h"
#include "mesh/geometry/ray_crossing.h"
#include "mesh/geometry/solid_angle.h"
#include "mesh/shells/disjoint_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace spherule::internal {
namespace {

constexpr std::int32_t kOpen = -1;

// Unit vectors along no axis, edge or diagonal that a model is likely to have.
const std::array<Eigen::Vector3d, 4> kDirections{
    Eigen::Vector3d(0.4517, 0.6293, 0.6323), Eigen::Vector3d(-0.7411, 0.3079, 0.5966),
    Eigen::Vector3d(0.5381, -0.8114, 0.2281), Eigen::Vector3d(-0.2893, -0.4729, -0.8323)};

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

ClosedShells::ClosedShells(const TriangleMesh& input, const MeshDistance& distance)
    : distance_(distance), shell_of_(input.triangles.size(), kOpen) {
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
  is_mesh_closed_ = unbalanced.empty();
  std::vector<char> is_open(mesh.triangles.size(), 0);  // of the roots
  for (const std::uint32_t triangle : unbalanced) is_open[parts.find(triangle)] = 1;

  std::vector<std::int32_t> shell_of_root(mesh.triangles.size(), kOpen);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t root = parts.find(static_cast<std::uint32_t>(i));
    if (is_open[root] != 0) continue;
    if (shell_of_root[root] == kOpen) {
      shell_of_root[root] = static_cast<std::int32_t>(shell_count_++);
    }
    shell_of_[i] = shell_of_root[root];
  }
}

bool ClosedShells::contain(const Eigen::Vector3d& point) const {
  return !windings(point).empty();
}

int ClosedShells::winding_number(const Eigen::Vector3d& point) const {
  int sum = 0;
  for (const auto& [shell, winding] : windings(point)) sum += winding;
  return sum;
}

ClosedShells::Windings ClosedShells::windings(const Eigen::Vector3d& point) const {
  if (shell_count_ == 0 || !distance_.box().contains(point)) return {};
  for (const Eigen::Vector3d& direction : kDirections) {
    if (auto counted = count_along(point, direction)) return *std::move(counted);
  }
  return sum_of_angles(point);
}

std::optional<ClosedShells::Windings> ClosedShells::count_along(
    const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  Windings crossings;
  const bool is_certain =
      distance_.visit_ray(point, direction, [&](const MeshDistance::Corners& t) {
        const std::int32_t shell = shell_of_[static_cast<std::size_t>(t.triangle)];
        if (shell == kOpen) return true;
        const RayCrossing crossing = ray_crossing(direction, t.a - point, t.b - point, t.c - point);
        if (crossing == RayCrossing::kUncertain) return false;
        if (crossing == RayCrossing::kFromBehind) crossings.emplace_back(shell, 1);
        if (crossing == RayCrossing::kFromFront) crossings.emplace_back(shell, -1);
        return true;
      });
  if (!is_certain) return std::nullopt;
  std::sort(crossings.begin(), crossings.end());
  Windings sums;
  for (std::size_t i = 0; i < crossings.size();) {
    const std::int32_t shell = crossings[i].first;
    int sum = 0;
    for (; i < crossings.size() && crossings[i].first == shell; ++i) sum += crossings[i].second;
    if (sum != 0) sums.emplace_back(shell, sum);
  }
  return sums;
}

ClosedShells::Windings ClosedShells::sum_of_angles(const Eigen::Vector3d& point) const {
  std::vector<double> angles(shell_count_, 0.0);
  distance_.visit_all([&](const MeshDistance::Corners& t) {
    const std::int32_t shell = shell_of_[static_cast<std::size_t>(t.triangle)];
    if (shell == kOpen) return;
    angles[static_cast<std::size_t>(shell)] += solid_angle(t.a - point, t.b - point, t.c - point);
  });
  Windings sums;
  for (std::size_t shell = 0; shell < shell_count_; ++shell) {
    const long winding = std::lround(angles[shell] / (4.0 * std::numbers::pi));
    if (winding != 0)
      sums.emplace_back(static_cast<std::int32_t>(shell), static_cast<int>(winding));
  }
  return sums;
}

}  // namespace spherule::internal
