// SPDX-License-Identifier: BSD-3-Clause
#include "io/polygon_triangles.h"

#include "base/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3i;

// Shares of a polygon's area: fans may turn over that much, and corners that span less are on one
// line.
constexpr double kTurned = 1e-9;
constexpr double kOnLine = 1e-12;
// Ears that are tried, and corners that are compared with them: at most, and for each corner of the
// polygon, so that a file takes time in proportion to its size.
constexpr std::uint64_t kMostWork = std::uint64_t{1} << 26;
constexpr std::uint64_t kWorkOfCorner = std::uint64_t{1} << 12;

// Twice the area, positive where a, b, c turn left.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// The corners along the axis that the normal (Newell's) is closest to, so that they turn left.
std::vector<Vector2d> projected(std::span<const Vector3d> vertices, std::span<const int> corners) {
  const auto corner = [&](std::size_t i) -> const Vector3d& {
    return vertices[static_cast<std::size_t>(corners[i])];
  };
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) {
    normal += (corner(i - 1) - corner(0)).cross(corner(i) - corner(0));
  }
  Eigen::Index along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  Eigen::Index first = (along + 1) % 3;
  Eigen::Index second = (along + 2) % 3;
  if (normal[along] < 0.0) std::swap(first, second);
  std::vector<Vector2d> points;
  points.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points.emplace_back(corner(i)[first], corner(i)[second]);
  }
  return points;
}

// Numbers of corners.
using Triple = std::array<std::size_t, 3>;

class EarClipping {
 public:
  EarClipping(std::span<const Vector2d> points, double area)
      : points_(points),
        on_line_(kOnLine * area),
        most_work_(std::min(kMostWork, kWorkOfCorner * points.size())),
        next_(points.size()),
        previous_(points.size()),
        is_left_(points.size(), 1) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      next_[i] = (i + 1) % points.size();
      previous_[next_[i]] = i;
    }
    Eigen::AlignedBox2d box;
    for (const Vector2d& point : points) box.extend(point);
    box.sizes().maxCoeff(&axis_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      sorted_.push_back({points[i][axis_], points[i][1 - axis_], i});
    }
    std::ranges::sort(sorted_, {}, &Place::along);
  }

  // Whether it came to an end: all but two corners are clipped.
  bool run() {
    std::size_t left = points_.size();
    std::size_t at = 0;
    std::size_t in_vain = 0;
    Rule rule = kStrict;
    bool has_clipped_flat = false;
    while (left > 3) {
      if (work_ > most_work_) return false;
      if (is_ear(at, rule)) {
        clip(at);
        has_clipped_flat = rule == kFlat;
        if (--left < sorted_.size() / 2) {
          std::erase_if(sorted_, [&](const Place& place) { return !is_left_[place.corner]; });
        }
        at = next_[next_[at]];
        in_vain = 0;
        if (rule != kFlat) rule = kStrict;
        continue;
      }
      at = next_[at];
      if (++in_vain < left) continue;
      if (rule == kFlat && !has_clipped_flat) return false;
      rule = rule == kFlat ? kStrict : static_cast<Rule>(rule + 1);
      has_clipped_flat = false;
      in_vain = 0;
    }
    triangles_.push_back({previous_[at], at, next_[at]});
    return true;
  }

  bool took_too_long() const { return work_ > most_work_; }
  const std::vector<Triple>& triangles() const { return triangles_; }

 private:
  // What makes an ear, tried in this order: no corner in it or on its edges; none within; that its
  // corners are on one line.
  enum Rule { kStrict, kInside, kFlat };

  bool is_ear(std::size_t at, Rule rule) {
    ++work_;
    const Vector2d& a = points_[previous_[at]];
    const Vector2d& b = points_[at];
    const Vector2d& c = points_[next_[at]];
    const double area = turn(a, b, c);
    if (rule == kFlat) return std::abs(area) <= on_line_;
    if (!(area > on_line_)) return false;
    const Vector2d least = a.cwiseMin(b).cwiseMin(c);
    const Vector2d most = a.cwiseMax(b).cwiseMax(c);
    const double low = least[1 - axis_], high = most[1 - axis_];
    auto place = std::ranges::lower_bound(sorted_, least[axis_], {}, &Place::along);
    for (; place != sorted_.end() && place->along <= most[axis_]; ++place) {
      ++work_;
      if (place->across < low || place->across > high) continue;
      const std::size_t i = place->corner;
      if (!is_left_[i] || i == at || i == previous_[at] || i == next_[at]) continue;
      if (blocks(i, a, b, c, rule)) return false;
    }
    return true;
  }

  // Whether corner i, or where it stands at a corner of the triangle an edge from it, is in there.
  bool blocks(std::size_t i, const Vector2d& a, const Vector2d& b, const Vector2d& c,
              Rule rule) const {
    const Vector2d& p = points_[i];
    const auto leads_in = [&](const Vector2d& before, const Vector2d& after) {
      const auto is_between = [&](const Vector2d& q) {
        return turn(before, p, q) > 0.0 && turn(p, after, q) > 0.0;
      };
      return is_between(points_[next_[i]]) || is_between(points_[previous_[i]]);
    };
    if (p == a) return leads_in(c, b);
    if (p == b) return leads_in(a, c);
    if (p == c) return leads_in(b, a);
    const double least = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
    return rule == kStrict ? least >= 0.0 : least > 0.0;
  }

  void clip(std::size_t at) {
    triangles_.push_back({previous_[at], at, next_[at]});
    next_[previous_[at]] = next_[at];
    previous_[next_[at]] = previous_[at];
    is_left_[at] = 0;
  }

  std::span<const Vector2d> points_;
  double on_line_;  // twice an area
  std::uint64_t most_work_;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> previous_;
  std::vector<char> is_left_;
  // Of a corner along the axis on which the polygon is longest, and across it.
  struct Place {
    double along;
    double across;
    std::size_t corner;
  };
  Eigen::Index axis_ = 0;
  std::vector<Place> sorted_;  // but for some that are clipped
  std::vector<Triple> triangles_;
  std::uint64_t work_ = 0;
};

}  // namespace

std::optional<std::vector<Vector3i>> polygon_triangles(std::span<const Vector3d> vertices,
                                                       std::span<const int> corners) {
  std::vector<Vector3i> triangles;
  if (corners.size() < 3) return triangles;
  triangles.reserve(corners.size() - 2);
  const auto fan = [&] {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
    }
    return triangles;
  };
  const std::vector<Vector2d> points = projected(vertices, corners);
  double area = 0.0;
  double turned = 0.0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const double of_triangle = turn(points[0], points[i - 1], points[i]);
    area += of_triangle;
    turned -= std::min(of_triangle, 0.0);
  }
  if (!(area > 0.0) || !std::isfinite(area) || turned <= kTurned * area) return fan();
  EarClipping ears(points, area);
  if (!ears.run()) return ears.took_too_long() ? std::nullopt : std::optional(fan());
  for (const auto& [a, b, c] : ears.triangles()) {
    triangles.emplace_back(corners[a], corners[b], corners[c]);
  }
  return triangles;
}

void add_polygon(TriangleMesh& mesh, std::span<const std::int64_t> corners,
                 std::size_t vertex_count, const std::string& subject) {
  if (vertex_count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(subject, "more than 2^31 vertices");
  }
  if (corners.size() / 4 > vertex_count) {
    throw Error(subject, "a face of " + std::to_string(corners.size()) + " corners, with " +
                             std::to_string(vertex_count) + " vertices");
  }
  for (const std::int64_t corner : corners) {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertex_count) {
      throw Error(subject, "a face refers to vertex " + std::to_string(corner) + " (from 0) of " +
                               std::to_string(vertex_count));
    }
  }
  if (corners.size() == 3) {
    mesh.triangles.emplace_back(static_cast<int>(corners[0]), static_cast<int>(corners[1]),
                                static_cast<int>(corners[2]));
    return;
  }
  std::vector<int> numbers;
  numbers.reserve(corners.size());
  for (const std::int64_t corner : corners) numbers.push_back(static_cast<int>(corner));
  const auto triangles = polygon_triangles(mesh.vertices, numbers);
  if (!triangles) {
    throw Error(subject, "a face of " + std::to_string(corners.size()) +
                             " corners that is not convex takes too long to divide into triangles");
  }
  mesh.triangles.insert(mesh.triangles.end(), triangles->begin(), triangles->end());
}

std::array<std::int64_t, 3> strip_triangle(std::span<const std::int64_t> strip, std::size_t last) {
  const std::size_t turned = last % 2;
  return {strip[last - 2 + turned], strip[last - 1 - turned], strip[last]};
}

}  // namespace spherule::internal
