// SPDX-License-Identifier: BSD-3-Clause
#include "collide/point_cloud.h"

#include "base/error.h"
#include "base/rounding.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <tuple>

namespace spherule {
namespace {

using Eigen::Vector3d;

// Of smaller cells the number may be infinite: every point then has one of its own.
constexpr double kLeastVoxel = 1e-290;

void require_length(double length, const char* subject) {
  if (!(length >= 0.0 && length <= kMaxCoordinate)) {
    throw Error(subject, "it is not a number from 0 to 1e15");
  }
}

void require_points(std::span<const Vector3d> points) {
  if (points.empty()) throw Error("point cloud", "it has no points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_usable_point(points[i])) {
      throw Error("point cloud", "point " + std::to_string(i) +
                                     " has a coordinate that is not a number up to 1e15");
    }
  }
}

bool before(const Vector3d& a, const Vector3d& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

// The cell of a point, which need not be the one that exact arithmetic says.
Vector3d cell_of(const Vector3d& point, double voxel) {
  return (point / voxel).array().floor();
}

// A sphere that contains those of radius `radius` about all the points.
Sphere sphere_of_cell(std::span<const Vector3d> points, double radius) {
  if (points.size() == 1) return {points.front(), radius};
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  Sphere sphere{box.center(), 0.0};
  for (const Vector3d& point : points) {
    sphere.radius = std::max(sphere.radius, distance_upper(sphere.center, point));
  }
  sphere.radius = add_up(sphere.radius, radius);
  return sphere;
}

}  // namespace

std::vector<Sphere> point_cloud_spheres(std::span<const Vector3d> points, double radius,
                                        const PointCloudOptions& options) {
  require_length(radius, "radius of the points");
  require_length(options.voxel, "side of the cells");
  require_points(points);
  std::vector<Vector3d> sorted(points.begin(), points.end());
  const bool has_cells = options.voxel >= kLeastVoxel;
  const auto by_cell = [&](const Vector3d& a, const Vector3d& b) {
    return before(cell_of(a, options.voxel), cell_of(b, options.voxel));
  };
  std::sort(sorted.begin(), sorted.end(), before);
  if (has_cells) std::stable_sort(sorted.begin(), sorted.end(), by_cell);
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());

  std::vector<Sphere> spheres;
  for (auto first = sorted.begin(); first != sorted.end();) {
    auto last = first + 1;
    while (has_cells && last != sorted.end() && !by_cell(*first, *last)) ++last;
    spheres.push_back(sphere_of_cell(std::span(first, last), radius));
    first = last;
  }
  return spheres;
}

SphereTree point_cloud_tree(std::span<const Vector3d> points, double radius,
                            const PointCloudOptions& options) {
  return build_tree(point_cloud_spheres(points, radius, options), options.build);
}

}  // namespace spherule
