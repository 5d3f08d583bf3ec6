// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/volume_ratio.h"

#include "simplifier/internal/mesh_box.h"
#include "simplifier/internal/random.h"

#include <Eigen/Geometry>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxLines = 4096.0;
constexpr double kMinLines = 256.0;
constexpr double kMaxTests = 1e8;  // of a line with a triangle or ball

// Lines along one axis, and the coordinates across it.
struct Axes {
  explicit Axes(int axis) : along(axis), first((axis + 1) % 3), second((axis + 2) % 3) {}

  Vector2d across(const Vector3d& p) const { return {p[first], p[second]}; }

  int along;
  int first;
  int second;
};

// Where a line enters or leaves something, and by how much the winding number changes there.
using Crossing = std::pair<double, int>;

// Length of the line on which the winding number is not 0. The crossings are sorted.
double length_inside(std::vector<Crossing>& crossings) {
  std::sort(crossings.begin(), crossings.end());
  double length = 0.0;
  int winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    winding += crossings[i].second;
    if (winding != 0) length += crossings[i + 1].first - crossings[i].first;
  }
  return length;
}

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

void cross_triangle(const std::array<Vector3d, 3>& corners, const Axes& axes, const Vector2d& line,
                    std::vector<Crossing>& crossings) {
  std::array<Vector2d, 3> to;
  for (std::size_t k = 0; k < 3; ++k) to[k] = axes.across(corners[k]) - line;
  std::array<double, 3> weights;
  for (std::size_t k = 0; k < 3; ++k) weights[k] = cross(to[(k + 1) % 3], to[(k + 2) % 3]);
  const bool is_front = weights[0] > 0.0 && weights[1] > 0.0 && weights[2] > 0.0;
  const bool is_back = weights[0] < 0.0 && weights[1] < 0.0 && weights[2] < 0.0;
  if (!is_front && !is_back) return;
  double at = 0.0;
  for (std::size_t k = 0; k < 3; ++k) at += weights[k] * corners[k][axes.along];
  crossings.emplace_back(at / (weights[0] + weights[1] + weights[2]), is_front ? 1 : -1);
}

void cross_ball(const Sphere& ball, const Axes& axes, const Vector2d& line,
                std::vector<Crossing>& crossings) {
  const double squared =
      ball.radius * ball.radius - (axes.across(ball.center) - line).squaredNorm();
  if (!(squared > 0.0)) return;
  const double half = std::sqrt(squared);
  crossings.emplace_back(ball.center[axes.along] - half, 1);
  crossings.emplace_back(ball.center[axes.along] + half, -1);
}

// One line through each cell of a grid across the shortest side of a box, so that none of them
// misses a thin plate. The cells go pairwise, along the first axis across.
struct Lines {
  Lines(const Eigen::AlignedBox3d& box, std::size_t things) : axes(shortest_of(box)) {
    const double wanted = std::clamp(kMaxTests / static_cast<double>(things), kMinLines, kMaxLines);
    const std::size_t count = static_cast<std::size_t>(std::sqrt(wanted)) / 2 * 2;
    const Vector2d low = axes.across(box.min());
    const Vector2d cell = axes.across(box.sizes()) / static_cast<double>(count);
    area = cell.prod();
    Random random(1);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        const double x = static_cast<double>(i) + random.unit();
        const double y = static_cast<double>(j) + random.unit();
        places.push_back(low + cell.cwiseProduct(Vector2d(x, y)));
      }
    }
  }

  static int shortest_of(const Eigen::AlignedBox3d& box) {
    int shortest = 0;
    box.sizes().minCoeff(&shortest);
    return shortest;
  }

  // Of each line, what lies in it; add_crossings(axes, line, crossings) notes where it is crossed.
  template <typename Cross>
  std::vector<double> lengths_inside(Cross add_crossings) const {
    std::vector<double> lengths(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
      std::vector<Crossing> crossings;
      add_crossings(axes, places[i], crossings);
      lengths[i] = length_inside(crossings);
    });
    return lengths;
  }

  Axes axes;
  std::vector<Vector2d> places;
  double area = 0.0;  // of a cell
};

void cross_mesh(const TriangleMesh& mesh, const Axes& axes, const Vector2d& line,
                std::vector<Crossing>& crossings) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    cross_triangle({corner(0), corner(1), corner(2)}, axes, line, crossings);
  }
}

double sum_of(const std::vector<double>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

}  // namespace

double estimate_volume_ratio(const TriangleMesh& mesh, std::span<const Sphere> balls) {
  const Lines through_mesh(box_of(mesh), mesh.triangles.size());
  const std::vector<double> solid = through_mesh.lengths_inside(
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        cross_mesh(mesh, axes, line, crossings);
      });
  const Lines through_balls(box_of(balls), balls.size());
  const std::vector<double> covered = through_balls.lengths_inside(
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        for (const Sphere& ball : balls) cross_ball(ball, axes, line, crossings);
      });
  return sum_of(covered) * through_balls.area / (sum_of(solid) * through_mesh.area);
}

EstimatedVolume estimate_filled_volume(const TriangleMesh& mesh, const ExternalSpheres& external) {
  const Eigen::AlignedBox3d& box = external.box;
  const Lines lines(box, mesh.triangles.size() + external.balls.size());
  // External balls and |M| are disjoint: on a line one or the other changes the winding number.
  std::vector<double> filled = lines.lengths_inside(
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        cross_mesh(mesh, axes, line, crossings);
        for (const Sphere& ball : external.balls) cross_ball(ball, axes, line, crossings);
        for (Crossing& crossing : crossings) {
          crossing.first = std::clamp(crossing.first, box.min()[axes.along], box.max()[axes.along]);
        }
      });
  const double side = box.sizes()[lines.axes.along];
  for (double& length : filled) length = std::max(0.0, side - length);
  // Two cells side by side: the square of their difference is, on average, at least the variance of
  // their sum.
  double variance = 0.0;
  for (std::size_t i = 0; i + 1 < filled.size(); i += 2) {
    const double difference = filled[i] - filled[i + 1];
    variance += difference * difference;
  }
  return {lines.area * sum_of(filled), lines.area * std::sqrt(variance)};
}

}  // namespace spherule::internal
