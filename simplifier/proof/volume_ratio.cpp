// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/volume_ratio.h"

#include "mesh/geometry/mesh_box.h"
#include "simplifier/support/random.h"

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

// Volume of what lies in the box and has this many things to cross, by lines along its shortest
// side, so that none of them misses a thin plate.
template <typename Cross>
double volume_in(const Eigen::AlignedBox3d& box, std::size_t things, Cross add_crossings) {
  int shortest = 0;
  box.sizes().minCoeff(&shortest);
  const Axes axes(shortest);
  const double lines = std::clamp(kMaxTests / static_cast<double>(things), kMinLines, kMaxLines);
  const auto count = static_cast<std::size_t>(std::sqrt(lines));
  const Vector2d low = axes.across(box.min());
  const Vector2d cell = axes.across(box.sizes()) / static_cast<double>(count);
  std::vector<Vector2d> places;
  Random random(1);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const double x = static_cast<double>(i) + random.unit();
      const double y = static_cast<double>(j) + random.unit();
      places.push_back(low + cell.cwiseProduct(Vector2d(x, y)));
    }
  }
  std::vector<double> lengths(places.size());
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t i) {
    std::vector<Crossing> crossings;
    add_crossings(axes, places[i], crossings);
    lengths[i] = length_inside(crossings);
  });
  return std::accumulate(lengths.begin(), lengths.end(), 0.0) * cell.prod();
}

}  // namespace

double estimate_volume_ratio(const TriangleMesh& mesh, std::span<const Sphere> balls) {
  const double solid = volume_in(
      box_of(mesh), mesh.triangles.size(),
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        for (const Eigen::Vector3i& t : mesh.triangles) {
          const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
          cross_triangle({corner(0), corner(1), corner(2)}, axes, line, crossings);
        }
      });
  const double covered =
      volume_in(box_of(balls), balls.size(),
                [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
                  for (const Sphere& ball : balls) cross_ball(ball, axes, line, crossings);
                });
  return covered / solid;
}

}  // namespace spherule::internal
