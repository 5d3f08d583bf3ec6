// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/motion/motion.h"
#include "tests/soak/random_scene.h"

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace spherule {

// Where the centres of a body's spheres are while it moves as collide/motion/motion.h defines it,
// with a bound of the error:
//     x(t) = base + t way + cos(t angle) arm + sin(t angle) side,
// where `arm` is the part of R0 (p - c) across the axis n and side = n x arm. Shares no code with
// collide/.
template <class Number>
class MotionTrack {
 public:
  using Point = std::array<Number, 3>;

  // What Motion::turning() is given.
  static MotionTrack turning(std::span<const Sphere> spheres, const Pose& start,
                             const Eigen::Vector3d& axis, double angle,
                             const Eigen::Vector3d& displacement, const Eigen::Vector3d& reference);
  // What Motion::between() is given; by the way round of less than half a turn.
  static MotionTrack between(std::span<const Sphere> spheres, const Pose& start, const Pose& end,
                             const Eigen::Vector3d& reference);

  // The same in a shorter type.
  template <class Other>
  explicit MotionTrack(const MotionTrack<Other>& other);

  std::size_t size() const { return spheres_.size(); }
  double radius(std::size_t i) const { return spheres_[i].radius; }
  // Bound of the error of a place and of the gap computed from it.
  Number error(std::size_t i) const { return spheres_[i].error; }

  void place(double t, std::vector<Point>& centers) const;

 private:
  template <class Other>
  friend class MotionTrack;

  struct TrackedSphere {
    Point base, arm, side;
    double radius;
    double extent;
    Number error;
  };

  MotionTrack() = default;
  void add_spheres(std::span<const Sphere> spheres, const Pose& start, const Point& axis,
                   const Eigen::Vector3d& reference, double extent);
  void set_errors();

  std::vector<TrackedSphere> spheres_;
  Point way_{};
  Number angle_ = 0;
};

extern template class MotionTrack<long double>;

template <class Number>
template <class Other>
MotionTrack<Number>::MotionTrack(const MotionTrack<Other>& other)
    : angle_(static_cast<Number>(other.angle_)) {
  const auto shorter = [](const auto& p) {
    return Point{static_cast<Number>(p[0]), static_cast<Number>(p[1]), static_cast<Number>(p[2])};
  };
  way_ = shorter(other.way_);
  for (const auto& sphere : other.spheres_) {
    spheres_.push_back({shorter(sphere.base), shorter(sphere.arm), shorter(sphere.side),
                        sphere.radius, sphere.extent, 0});
  }
  set_errors();
}

// The images of p and c and their difference err by 64 u of the extent (exact_oracle.cpp); the axis
// by 3 u made unit, or 16 u divided by half the sine of the angle where it comes from a quotient of
// rotations, which moves a point by 32 u of its arm at most; t angle and the angle by 10 u |angle|,
// sine and cosine by 4 u each; the sums by 8 u of the extent. 256 u (1 + |angle|) of the extent
// bounds all of it, with the length of a difference and the radii.
template <class Number>
void MotionTrack<Number>::set_errors() {
  using std::abs;
  const Number share = 128 * std::numeric_limits<Number>::epsilon() * (1 + abs(angle_));
  for (TrackedSphere& sphere : spheres_) sphere.error = share * static_cast<Number>(sphere.extent);
}

template <class Number>
void MotionTrack<Number>::place(double t, std::vector<Point>& centers) const {
  const Number at = t, c = std::cos(at * angle_), s = std::sin(at * angle_);
  centers.resize(spheres_.size());
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const TrackedSphere& sphere = spheres_[i];
    for (std::size_t k = 0; k < 3; ++k) {
      centers[i][k] = sphere.base[k] + at * way_[k] + (c * sphere.arm[k] + s * sphere.side[k]);
    }
  }
}

}  // namespace spherule
