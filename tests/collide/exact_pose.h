// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a pose does to a point, in whatever numbers a test wants. It shares no code with the
// library: the rotation of q / norm(q) is rational in the components of q.

#include "geometry/pose.h"

#include <array>

namespace spherule::test {

template <class Number>
using Vector = std::array<Number, 3>;

// Image of `p` under exactly the rotation of q / norm(q) and the translation.
template <class Number>
Vector<Number> transform(const Pose& pose, const Vector<Number>& p) {
  const Number w = pose.rotation().w();
  const Number x = pose.rotation().x();
  const Number y = pose.rotation().y();
  const Number z = pose.rotation().z();
  const Number ww = w * w, xx = x * x, yy = y * y, zz = z * z;
  const Number n = ww + xx + yy + zz;
  const auto& t = pose.translation();
  return {
      ((ww + xx - yy - zz) * p[0] + 2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2]) / n +
          t.x(),
      (2 * (x * y + w * z) * p[0] + (ww - xx + yy - zz) * p[1] + 2 * (y * z - w * x) * p[2]) / n +
          t.y(),
      (2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] + (ww - xx - yy + zz) * p[2]) / n +
          t.z()};
}

template <class Number>
Vector<Number> exact(const Eigen::Vector3d& p) {
  return {Number(p.x()), Number(p.y()), Number(p.z())};
}

template <class Number>
Number squared_distance(const Vector<Number>& a, const Vector<Number>& b) {
  const Number x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

}  // namespace spherule::test
