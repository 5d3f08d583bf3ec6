// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/random_scene.h"
#include "tests/support/exact/poses.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace spherule::test {

// A moving body: its spheres, and the exact motion in two types.
struct MovingSpheres {
  std::span<const Sphere> spheres;
  ExactMotion<double> near;
  ExactMotion<long double> exact;
  double extent;  // |t| + |displacement| + 2 |reference|, of the motion
  double angle;
};

// Whether two moving bodies are in contact at an instant, from all pairs of spheres: by double
// where that is certain, else by long double. Shares no code with collide/.
//
// The error of a gap: the images of a centre p and of the reference c and their difference err by
// 64 u of the extent (exact_oracle.cpp); the axis by 3 u made unit, or 16 u divided by half the
// sine of the angle where it comes from a quotient of rotations, which moves a point by 64 u of its
// arm at most; t angle and the angle by 10 u |angle|, sine and cosine by 4 u each; the sums by 16 u
// of the extent. 512 u (1 + |angle|) of the extent bounds all of it, with the length of a
// difference and the radii.
class MotionOracle {
 public:
  MotionOracle(const MovingSpheres& a, const MovingSpheres& b) : a_(a), b_(b) {}

  enum class Contact { kNo, kYes, kUncertain };

  // Whether the exact gap at t is at most the clearance.
  Contact at(double t, double clearance) const {
    if (contact<double>(t, clearance) == Contact::kNo) return Contact::kNo;
    return contact<long double>(t, clearance);
  }

  // Appends the spheres where they are at t, rounded.
  void place(double t, std::vector<Sphere>& placed_a, std::vector<Sphere>& placed_b) const {
    for (const auto& [body, placed] : {std::pair(&a_, &placed_a), std::pair(&b_, &placed_b)}) {
      for (const Sphere& sphere : body->spheres) {
        const Vector<double> p = body->near.at(t, sphere.center);
        placed->push_back({{p[0], p[1], p[2]}, sphere.radius});
      }
    }
  }

 private:
  template <class Number>
  struct Placed {
    Vector<Number> center;
    Number radius;
    Number error;
  };

  template <class Number>
  static std::vector<Placed<Number>> placed(const MovingSpheres& body, double t) {
    std::vector<Placed<Number>> all;
    const Number share = 256 * std::numeric_limits<Number>::epsilon() *
                         (1 + static_cast<Number>(std::abs(body.angle)));
    for (const Sphere& sphere : body.spheres) {
      const Number extent = (body.extent + sphere.center.lpNorm<1>() + sphere.radius) * (1 + 1e-9);
      Vector<Number> center;
      if constexpr (std::is_same_v<Number, double>) {
        center = body.near.at(t, sphere.center);
      } else {
        center = body.exact.at(t, sphere.center);
      }
      all.push_back({center, sphere.radius, share * extent});
    }
    return all;
  }

  template <class Number>
  Contact contact(double t, double clearance) const {
    const auto of_a = placed<Number>(a_, t), of_b = placed<Number>(b_, t);
    const Number clear = clearance;
    Contact result = Contact::kNo;
    for (const Placed<Number>& p : of_a) {
      for (const Placed<Number>& q : of_b) {
        const Number gap = std::sqrt(squared_distance(p.center, q.center)) - (p.radius + q.radius);
        const Number error =
            p.error + q.error + 16 * std::numeric_limits<Number>::epsilon() * clear;
        if (gap <= clear - error) return Contact::kYes;
        if (gap <= clear + error) result = Contact::kUncertain;
      }
    }
    return result;
  }

  MovingSpheres a_, b_;
};

}  // namespace spherule::test
