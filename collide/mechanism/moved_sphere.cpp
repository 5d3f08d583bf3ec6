// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/moved_sphere.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule::internal {
namespace {

double length(const double (&v)[3]) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

MovedSphere::MovedSphere(const KernelFrame* frames, std::size_t count, double error)
    : frames_(frames), error_(error), joints_(count) {}

void MovedSphere::place(std::int32_t frame, const double* center, double radius,
                        const KernelPose* poses, const double* configuration) {
  const auto& at = poses[frame].columns;
  double c[3];
  for (int i = 0; i < 3; ++i) {
    c[i] = at[0][i] * center[0] + at[1][i] * center[1] + at[2][i] * center[2] + at[3][i];
  }
  radius_ = radius;
  count_ = 0;
  double farthest = 0.0;
  for (std::int32_t f = frame; f >= 0; f = frames_[f].parent) {
    const KernelFrame& of = frames_[f];
    const auto& axis = poses[f].columns[2];
    const auto& origin = poses[f].columns[3];
    const double from[3] = {c[0] - origin[0], c[1] - origin[1], c[2] - origin[2]};
    Joint& joint = joints_[count_++];
    joint.variable = of.variable;
    joint.prismatic = of.prismatic;
    joint.at = configuration[of.variable];
    joint.reach = length(from) + radius;
    farthest = std::max(farthest, joint.reach);
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      joint.turn_rate[i] = of.prismatic ? 0.0 : axis[i];
      joint.center_rate[i] = of.prismatic ? axis[i] : axis[j] * from[k] - axis[k] * from[j];
    }
  }
  room_ = kRoom * farthest;
  for (std::size_t i = 0; i < count_; ++i) {
    joints_[i].reach = joints_[i].prismatic ? 1.0 : joints_[i].reach + room_;
  }
}

double MovedSphere::way_to(const double* configuration) const {
  return way({configuration});
}

double MovedSphere::way_along(const double* from, const double* to) const {
  return way({from, to});
}

template <std::size_t kEnds>
double MovedSphere::way(const double* const (&ends)[kEnds]) const {
  double moved[kEnds][3] = {};
  double turned[kEnds][3] = {};
  double changes = 0.0;
  double ways = 0.0;  // sum of |D_k| L_k
  double second = 0.0;
  for (std::size_t n = 0; n < count_; ++n) {
    const Joint& joint = joints_[n];
    double size = 0.0;
    for (std::size_t end = 0; end < kEnds; ++end) {
      const double change = ends[end][joint.variable] - joint.at;
      for (int i = 0; i < 3; ++i) {
        moved[end][i] += change * joint.center_rate[i];
        turned[end][i] += change * joint.turn_rate[i];
      }
      size = std::max(size, std::abs(change));
    }
    // From the tip: a rotation intersects the ways of itself, half, and of all beyond it.
    const double way = size * joint.reach;
    if (!joint.prismatic) second += size * (0.5 * way + ways);
    ways += way;
    changes += size;
  }
  if (count_ == 0 || !(ways <= room_)) return std::numeric_limits<double>::infinity();
  double first = 0.0;
  for (std::size_t end = 0; end < kEnds; ++end) {
    first = std::max(first, length(moved[end]) + length(turned[end]) * radius_);
  }
  return (first + second) * (1.0 + kRelative) + changes * error_;
}

}  // namespace spherule::internal
