// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/paper/cover_history.h"

#include "mesh/shells/closed_shells.h"
#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSurfaceSamples = 20000;
constexpr std::size_t kVolumeSamples = 40000;
constexpr double kFar = std::numeric_limits<double>::infinity();

std::vector<Vector3d> points_on(const TriangleMesh& mesh, std::size_t count, Random& random) {
  std::vector<double> cumulative;
  cumulative.reserve(mesh.triangles.size());
  double total = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    total += (b - a).cross(c - a).norm();
    cumulative.push_back(total);
  }
  std::vector<Vector3d> points(count);
  for (Vector3d& p : points) {
    const auto it = std::upper_bound(cumulative.begin(), cumulative.end(), random.unit() * total);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(it - cumulative.begin()),
                                         mesh.triangles.size() - 1);
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[i]);
    const double s = std::sqrt(random.unit());
    const double v = random.unit();
    p = (1.0 - s) * a + s * (1.0 - v) * b + s * v * c;
  }
  return points;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

CoverHistory::CoverHistory(const TriangleMesh& mesh, const MeshDistance& distance,
                           const Eigen::AlignedBox3d& box, double margin, std::uint64_t seed) {
  Random random(seed);
  for (const Vector3d& p : points_on(mesh, kSurfaceSamples, random)) surface_.push_back({p, kFar});
  const Vector3d grow = Vector3d::Constant(margin);
  const Eigen::AlignedBox3d field(box.min() - grow, box.max() + grow);
  std::vector<Vector3d> points(kVolumeSamples);
  for (Vector3d& p : points) p = random.in(field);
  const ClosedShells shells(mesh, distance);
  std::vector<char> inside(points.size());
  parallel_for(0, points.size(), [&](std::size_t i) {
    const bool is_inside = shells.is_mesh_closed()
                               ? shells.winding_number(points[i]) != 0
                               : std::abs(distance.winding_number(points[i])) > 0.5;
    inside[i] = is_inside ? 1 : 0;
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    (inside[i] != 0 ? solid_ : outside_).push_back({points[i], kFar});
  }
}

void CoverHistory::update(std::vector<Sample>& samples, const Sphere& sphere) {
  for (Sample& s : samples)
    s.gap = std::min(s.gap, (s.point - sphere.center).norm() - sphere.radius);
}

void CoverHistory::add(const Sphere& sphere) {
  for (std::vector<Sample>* samples : {&surface_, &solid_, &outside_}) update(*samples, sphere);
  ++count_;
}

CoverHistoryEntry CoverHistory::entry(double inflation) const {
  const auto covered = [](const std::vector<Sample>& samples, double by) {
    return static_cast<std::size_t>(std::count_if(samples.begin(), samples.end(),
                                                  [by](const Sample& s) { return s.gap <= by; }));
  };
  double furthest = 0.0;
  for (const Sample& s : surface_) furthest = std::max(furthest, s.gap);
  CoverHistoryEntry e;
  e.sphere_count = count_;
  e.surface_error_before = furthest;
  e.surface_error_after = std::max(0.0, furthest - inflation);
  e.coverage_before = share(covered(solid_, 0.0), solid_.size());
  e.coverage_after = share(covered(solid_, inflation), solid_.size());
  e.excess_before = share(covered(outside_, 0.0), solid_.size());
  e.excess_after = share(covered(outside_, inflation), solid_.size());
  return e;
}

}  // namespace spherule::internal
