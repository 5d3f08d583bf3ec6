// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/internal/hull_corners.h"

#include "robot/pairs/internal/hull_direction.h"

#include <algorithm>
#include <cstddef>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFew = 200;
// Each time that so many corners are kept the tolerance doubles, so that meshes that are very fine
// for their size do not take time in proportion to the square of their points.
constexpr std::size_t kMany = 2000;

// What HullDirection::distance may lack by rounding, of the largest norm of a point: it is the
// length of a combination of up to four corners whose weights add up to 1, none below -4 u, however
// they were found: less than 40 u.
constexpr double kRounding = 1e-14;

class Chooser {
 public:
  Chooser(std::span<const Vector3d> points, double tolerance)
      : points_(points), is_kept_(points.size(), false), tolerance_(tolerance) {}

  HullCorners run() {
    for (int face = 0; face < 27; ++face) {
      const Vector3d direction(face % 3 - 1, face / 3 % 3 - 1, face / 9 - 1);
      if (!direction.isZero()) keep(least_along(points_, -direction));
    }
    double radius = 0.0;
    double reach = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      reach = std::max(reach, points_[i].lpNorm<1>());
      radius = std::max(radius, keep_until_near(i));
    }
    return {std::move(corners_), radius + kRounding * reach};
  }

 private:
  // Keeps points until the hull of those that are kept is near to this one; how far it then is.
  double keep_until_near(std::size_t index) {
    while (!is_kept_[index]) {
      const HullDirection found =
          hull_direction(points_.subspan(index, 1), corners_, Eigen::Matrix3d::Identity(),
                         Vector3d::Zero(), points_[index] - corners_.front(), tolerance_);
      if (found.distance <= tolerance_) return found.distance;
      const std::size_t beyond = least_along(points_, -found.direction);
      keep(is_kept_[beyond] ? index : beyond);
    }
    return 0.0;
  }

  void keep(std::size_t index) {
    if (is_kept_[index]) return;
    is_kept_[index] = true;
    corners_.push_back(points_[index]);
    if (corners_.size() % kMany == 0) tolerance_ *= 2.0;
  }

  std::span<const Vector3d> points_;
  std::vector<bool> is_kept_;
  double tolerance_;
  std::vector<Vector3d> corners_;
};

}  // namespace

HullCorners hull_corners(std::span<const Vector3d> points, double tolerance) {
  if (points.size() <= kFew) return {{points.begin(), points.end()}, 0.0};
  return Chooser(points, tolerance).run();
}

}  // namespace spherule::internal
