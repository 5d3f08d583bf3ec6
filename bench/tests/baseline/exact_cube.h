// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace spherule::test {

using Rational = boost::multiprecision::cpp_rational;
using ExactPoint = std::array<Rational, 3>;

inline ExactPoint exact(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

// Whether the closed triangle and the closed cube of half the edge `half` have a point in common,
// in rational arithmetic: the triangle is clipped at the six faces in turn.
inline bool exactly_intersects(const std::array<Eigen::Vector3d, 3>& triangle,
                               const ExactPoint& center, const Rational& half) {
  std::vector<ExactPoint> polygon = {exact(triangle[0]), exact(triangle[1]), exact(triangle[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto beyond = [&](const ExactPoint& p) -> Rational {
        return side * (p[axis] - center[axis]) - half;
      };
      std::vector<ExactPoint> clipped;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ExactPoint& a = polygon[i];
        const ExactPoint& b = polygon[(i + 1) % polygon.size()];
        const Rational da = beyond(a);
        const Rational db = beyond(b);
        if (da <= 0) clipped.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
          const Rational share = da / (da - db);
          ExactPoint cut;
          for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + share * (b[k] - a[k]);
          clipped.push_back(cut);
        }
      }
      polygon = clipped;
    }
  }
  return !polygon.empty();
}

}  // namespace spherule::test
