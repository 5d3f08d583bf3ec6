// SPDX-License-Identifier: BSD-3-Clause
#include "bench/closing/triangle_tree.h"

#include "geometry/median_split.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace spherule::closing {
namespace {

using Eigen::Vector3d;

double squared_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).squaredNorm();
}

// The least of the squared distances to the edges and, if the foot of the perpendicular is inside,
// to the plane.
double squared_to_triangle(const Vector3d& p, const std::array<Vector3d, 3>& t) {
  const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double area = normal.squaredNorm();
  bool is_above = area > 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d& from = t[k];
    const Vector3d& to = t[(k + 1) % 3];
    best = std::min(best, squared_to_segment(p, from, to));
    is_above = is_above && normal.cross(to - from).dot(p - from) >= 0.0;
  }
  if (!is_above) return best;
  const double height = normal.dot(p - t[0]);
  return std::min(best, height * height / area);
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  for (const Eigen::Vector3i& t : mesh.triangles) triangles_.push_back(corners_of(mesh, t));
  constexpr std::size_t kLeaf = 4;
  nodes_.push_back({.box = {}, .begin = 0, .end = triangles_.size()});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::size_t begin = nodes_[n].begin;
    const std::size_t end = nodes_[n].end;
    for (std::size_t i = begin; i < end; ++i) {
      for (const Vector3d& corner : triangles_[i]) nodes_[n].box.extend(corner);
    }
    if (end - begin <= kLeaf) continue;
    const Eigen::Index axis = internal::longest_axis(nodes_[n].box);
    const std::size_t middle =
        begin + internal::split_at_median(
                    std::span(triangles_).subspan(begin, end - begin),
                    [axis](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; });
    nodes_[n].children = nodes_.size();
    nodes_.push_back({.box = {}, .begin = begin, .end = middle});
    nodes_.push_back({.box = {}, .begin = middle, .end = end});
  }
}

double TriangleTree::distance(const Vector3d& p, double limit) const {
  double best = limit * limit;
  std::array<std::pair<double, std::size_t>, 128> waiting;
  std::size_t count = 0;
  waiting[count++] = {nodes_[0].box.squaredExteriorDistance(p), 0};
  while (count > 0) {
    const auto [squared, n] = waiting[--count];
    if (squared >= best) continue;
    const Node& node = nodes_[n];
    if (node.children == 0) {
      for (std::size_t i = node.begin; i < node.end; ++i) {
        best = std::min(best, squared_to_triangle(p, triangles_[i]));
      }
      continue;
    }
    std::pair near{nodes_[node.children].box.squaredExteriorDistance(p), node.children};
    std::pair far{nodes_[node.children + 1].box.squaredExteriorDistance(p), node.children + 1};
    if (far.first < near.first) std::swap(near, far);
    waiting[count++] = far;
    waiting[count++] = near;
  }
  return std::sqrt(best);
}

}  // namespace spherule::closing
