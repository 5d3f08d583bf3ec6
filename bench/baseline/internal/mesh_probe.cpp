// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/mesh_probe.h"

#include "geometry/median_split.h"
#include "geometry/triangles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafSize = 8;
// A group is taken as one from this many times its reach on; its error there is some thousandths.
constexpr double kFar = 3.0;

}  // namespace

MeshProbe::MeshProbe(const TriangleMesh& mesh) : distance_(mesh) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    corners_.push_back({a, b, c});
  }
  build(0, static_cast<std::int32_t>(corners_.size()));
}

void MeshProbe::build(std::int32_t begin, std::int32_t end) {
  const std::size_t self = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  Eigen::AlignedBox3d box;
  const auto part = std::span(corners_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  for (const Corners& t : part) {
    for (const Vector3d& p : {t.a, t.b, t.c}) box.extend(p);
    node.area += 0.5 * (t.b - t.a).cross(t.c - t.a);
  }
  node.center = box.center();
  for (const Corners& t : part) {
    for (const Vector3d& p : {t.a, t.b, t.c}) {
      node.reach = std::max(node.reach, (p - node.center).norm());
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return;
  const Eigen::Index axis = longest_axis(box);
  const auto key = [axis](const Corners& t) { return t.a[axis] + t.b[axis] + t.c[axis]; };
  const std::int32_t middle = begin + static_cast<std::int32_t>(split_at_median(part, key));
  build(begin, middle);
  nodes_[self].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

double MeshProbe::solid_angle_of(std::int32_t index, const Vector3d& point) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  const Vector3d to = node.center - point;
  const double away = to.norm();
  if (away > kFar * node.reach) return node.area.dot(to) / (away * away * away);
  if (node.right >= 0) {
    return solid_angle_of(index + 1, point) + solid_angle_of(node.right, point);
  }
  double angle = 0.0;
  for (std::int32_t i = node.begin; i < node.end; ++i) {
    const Corners& t = corners_[static_cast<std::size_t>(i)];
    angle += solid_angle(t.a - point, t.b - point, t.c - point);
  }
  return angle;
}

bool MeshProbe::is_inside(const Vector3d& point) const {
  if (!distance_.box().contains(point)) return false;
  return std::abs(solid_angle_of(0, point)) > 2.0 * std::numbers::pi;
}

double MeshProbe::clearance(const Vector3d& point) const {
  const SurfaceDistance d = distance_(point);
  return is_inside(point) ? d.lower : -d.upper;
}

}  // namespace spherule::internal
