// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shells/closed_shells.h"

#include "mesh/geometry/ray.h"
#include "mesh/geometry/solid_angle.h"
#include "mesh/geometry/weld.h"
#include "mesh/shells/mesh_shells.h"

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

}  // namespace

ClosedShells::ClosedShells(const TriangleMesh& mesh, const MeshDistance& distance)
    : distance_(distance), shell_of_(mesh.triangles.size(), kOpen) {
  const TriangleMesh welded = weld(mesh);
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(welded.triangles.size());
  for (const Eigen::Vector3i& t : welded.triangles) triangles.push_back({t[0], t[1], t[2]});
  const MeshShells found = find_shells(triangles, welded.vertices);
  is_mesh_closed_ = found.are_balanced;
  for (std::size_t i = 0; i < shell_of_.size(); ++i) {
    shell_of_[i] = found.roles[i].shell;
    shell_count_ = std::max(shell_count_, static_cast<std::size_t>(shell_of_[i] + 1));
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
  const Ray ray(point, 0.0, direction);
  Windings crossings;
  const bool is_certain =
      distance_.visit_ray(point, direction, [&](const MeshDistance::Corners& t) {
        const std::int32_t shell = shell_of_[static_cast<std::size_t>(t.triangle)];
        if (shell == kOpen) return true;
        const std::optional<int> crossing = ray.crossing({t.a, t.b, t.c});
        if (crossing.value_or(0) != 0) crossings.emplace_back(shell, *crossing);
        return crossing.has_value();
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
