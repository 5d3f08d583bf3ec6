// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/volume_ratio.h"

#include "mesh/geometry/mesh_box.h"
#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"

#include <Eigen/Geometry>

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
constexpr double kMaxTests = 1e8;  // of a line with a triangle or sphere

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

void cross_sphere(const Sphere& sphere, const Axes& axes, const Vector2d& line,
                  std::vector<Crossing>& crossings) {
  const double squared =
      sphere.radius * sphere.radius - (axes.across(sphere.center) - line).squaredNorm();
  if (!(squared > 0.0)) return;
  const double half = std::sqrt(squared);
  crossings.emplace_back(sphere.center[axes.along] - half, 1);
  crossings.emplace_back(sphere.center[axes.along] + half, -1);
}

// One line through each cell of a grid across the shortest side of a box, so that none of them
// misses a thin plate. The cells go pairwise, along the first axis across.
struct Lines {
  Lines(const Eigen::AlignedBox3d& box, double wanted)
      : axes(shortest_of(box)),
        count(static_cast<std::size_t>(std::sqrt(wanted))),
        low(axes.across(box.min())),
        cell(axes.across(box.sizes()) / static_cast<double>(count)),
        area(cell.prod()) {
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
    parallel_for(0, places.size(), [&](std::size_t i) {
      std::vector<Crossing> crossings;
      add_crossings(axes, places[i], crossings);
      lengths[i] = length_inside(crossings);
    });
    return lengths;
  }

  // Calls cross(place) for the places of a row that lie in a box across.
  template <typename Cross>
  void for_each_in(std::size_t row, const Vector2d& least, const Vector2d& greatest,
                   Cross cross) const {
    const Vector2d from = (least - low).cwiseQuotient(cell);
    const Vector2d to = (greatest - low).cwiseQuotient(cell);
    const auto at = static_cast<double>(row);
    const auto last = static_cast<double>(count) - 1.0;
    if (to.x() < at || from.x() > at + 1.0 || to.y() < 0.0 || from.y() > last + 1.0) return;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(from.y())));
    const auto end = static_cast<std::size_t>(std::min(last, std::floor(to.y()))) + 1;
    for (std::size_t j = begin; j < end; ++j) cross(row * count + j);
  }

  Axes axes;
  std::size_t count;  // rows, and lines in each
  Vector2d low;
  Vector2d cell;
  double area;  // of a cell
  std::vector<Vector2d> places;
};

double number_of_lines(std::size_t things) {
  return std::clamp(kMaxTests / static_cast<double>(things), kMinLines, kMaxLines);
}

std::array<Vector3d, 3> corners_of(const TriangleMesh& mesh, const Eigen::Vector3i& t) {
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return {corner(0), corner(1), corner(2)};
}

double sum_of(const std::vector<double>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}

}  // namespace

double estimate_volume_ratio(const TriangleMesh& mesh, std::span<const Sphere> spheres) {
  const Lines through_mesh(box_of(mesh), number_of_lines(mesh.triangles.size()));
  const std::vector<double> solid = through_mesh.lengths_inside(
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        for (const Eigen::Vector3i& t : mesh.triangles) {
          cross_triangle(corners_of(mesh, t), axes, line, crossings);
        }
      });
  const Lines through_spheres(box_of(spheres), number_of_lines(spheres.size()));
  const std::vector<double> covered = through_spheres.lengths_inside(
      [&](const Axes& axes, const Vector2d& line, std::vector<Crossing>& crossings) {
        for (const Sphere& sphere : spheres) cross_sphere(sphere, axes, line, crossings);
      });
  return sum_of(covered) * through_spheres.area / (sum_of(solid) * through_mesh.area);
}

EstimatedVolume estimate_filled_volume(const TriangleMesh& mesh, const ExternalSpheres& external) {
  const Eigen::AlignedBox3d& box = external.box;
  const Lines lines(box, kMaxLines);
  const Axes& axes = lines.axes;
  const double low = box.min()[axes.along];
  const double high = box.max()[axes.along];
  std::vector<double> filled(lines.places.size());
  parallel_for(0, lines.count, [&](std::size_t row) {
    // External spheres and |M| are disjoint: one or the other changes the winding number.
    std::vector<std::vector<Crossing>> crossings(lines.count);
    const auto of = [&](std::size_t place) -> std::vector<Crossing>& {
      return crossings[place - row * lines.count];
    };
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const std::array<Vector3d, 3> corners = corners_of(mesh, t);
      const Vector3d least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      const Vector3d greatest = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
      lines.for_each_in(row, axes.across(least), axes.across(greatest), [&](std::size_t place) {
        cross_triangle(corners, axes, lines.places[place], of(place));
      });
    }
    for (const Sphere& sphere : external.spheres) {
      const Vector3d reach = Vector3d::Constant(sphere.radius);
      lines.for_each_in(
          row, axes.across(sphere.center - reach), axes.across(sphere.center + reach),
          [&](std::size_t place) { cross_sphere(sphere, axes, lines.places[place], of(place)); });
    }
    for (std::size_t j = 0; j < lines.count; ++j) {
      for (Crossing& crossing : crossings[j]) {
        crossing.first = std::clamp(crossing.first, low, high);
      }
      filled[row * lines.count + j] = std::max(0.0, high - low - length_inside(crossings[j]));
    }
  });
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
