// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/hull_direction.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 24;

// Up to four corners of the difference of the two hulls.
struct Simplex {
  std::array<Vector3d, 4> corners;
  std::size_t size = 0;

  // Reduces it to the face that is nearest to the origin and returns the point of that.
  Vector3d nearest() {
    double least = std::numeric_limits<double>::infinity();
    Vector3d result = corners[0];
    unsigned kept = 1;
    for (unsigned face = 1; face < (1U << size); ++face) {
      std::array<Vector3d, 4> of;
      of.fill(Vector3d::Zero());
      int count = 0;
      for (std::size_t i = 0; i < size; ++i) {
        if ((face >> i & 1U) != 0) of[static_cast<std::size_t>(count++)] = corners[i];
      }
      Vector3d point = of[0];
      if (count > 1) {
        Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, count - 1);
        for (int i = 1; i < count; ++i) edges.col(i - 1) = of[static_cast<std::size_t>(i)] - of[0];
        using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
        using Parts = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
        const Gram gram = edges.transpose() * edges;
        const Parts right = edges.transpose() * -of[0];
        const Parts parts = gram.ldlt().solve(right);
        if (!parts.allFinite() || parts.minCoeff() < 0.0 || parts.sum() > 1.0) continue;
        point = of[0] + edges * parts;
      }
      if (point.squaredNorm() >= least) continue;
      least = point.squaredNorm();
      result = point;
      kept = face;
    }
    std::size_t left = 0;
    for (std::size_t i = 0; i < size; ++i) {
      if ((kept >> i & 1U) != 0) corners[left++] = corners[i];
    }
    size = left;
    return result;
  }
};

}  // namespace

std::size_t least_along(std::span<const Vector3d> points, const Vector3d& axis) {
  std::size_t least = 0;
  double value = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = axis.dot(points[i]);
    if (along >= value) continue;
    value = along;
    least = i;
  }
  return least;
}

HullDirection hull_direction(std::span<const Vector3d> first, std::span<const Vector3d> second,
                             const Eigen::Matrix3d& first_from_second,
                             const Vector3d& origin_of_second, const Vector3d& start,
                             double enough) {
  HullDirection best{.direction = start.stableNormalized(),
                     .gap = -std::numeric_limits<double>::infinity()};
  Vector3d way = best.direction;
  Simplex simplex;
  for (int step = 0; step < kSteps; ++step) {
    const double length = way.norm();
    if (simplex.size > 0) best.distance = std::min(best.distance, length);
    if (!(length > 1e-12) || best.distance <= enough) break;
    const Vector3d axis = way / length;
    const Vector3d corner =
        first[least_along(first, axis)] -
        (first_from_second * second[least_along(second, first_from_second.transpose() * -axis)] +
         origin_of_second);
    const double gap = axis.dot(corner);
    if (gap > best.gap) {
      best.direction = axis;
      best.gap = gap;
    }
    // As far as it gets: the hulls are not farther apart than `length`.
    if (simplex.size > 0 && gap > 0.0 && length - best.gap <= 1e-3 * length) break;
    for (std::size_t i = 0; i < simplex.size; ++i) {
      if (simplex.corners[i] == corner) return best;
    }
    if (simplex.size == 4) break;
    simplex.corners[simplex.size++] = corner;
    way = simplex.nearest();
  }
  return best;
}

}  // namespace spherule::internal
