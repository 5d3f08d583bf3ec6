// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/motion_track.h"

#include <array>
#include <cstddef>
#include <vector>

namespace spherule {

// Whether two moving bodies are in contact at an instant, from all pairs of spheres: by double
// where that is certain, else by long double. Both tracks must outlive it.
class MotionOracle {
 public:
  MotionOracle(const MotionTrack<long double>& a, const MotionTrack<long double>& b)
      : exact_a_(a), exact_b_(b), a_(a), b_(b) {}

  enum class Contact { kNo, kYes, kUncertain };

  // Whether the exact gap at t is at most the clearance.
  Contact at(double t, double clearance);

  // Appends the spheres where they are at t, rounded.
  void place(double t, std::vector<Sphere>& placed_a, std::vector<Sphere>& placed_b);

 private:
  template <class Number>
  struct Centers {
    std::vector<std::array<Number, 3>> a, b;

    void place(const MotionTrack<Number>& track_a, const MotionTrack<Number>& track_b, double t) {
      track_a.place(t, a);
      track_b.place(t, b);
    }
    Number squared_distance(std::size_t i, std::size_t j) const {
      const Number x = a[i][0] - b[j][0], y = a[i][1] - b[j][1], z = a[i][2] - b[j][2];
      return x * x + y * y + z * z;
    }
  };

  bool may_touch(double t, double clearance);

  const MotionTrack<long double>& exact_a_;
  const MotionTrack<long double>& exact_b_;
  const MotionTrack<double> a_, b_;
  Centers<double> near_;
  Centers<long double> exact_;
};

}  // namespace spherule
