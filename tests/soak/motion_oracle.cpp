// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/motion_oracle.h"

#include <cmath>
#include <limits>

namespace spherule {
namespace {

void add_spheres(const std::vector<std::array<double, 3>>& centers,
                 const MotionTrack<double>& track, std::vector<Sphere>& spheres) {
  for (std::size_t i = 0; i < centers.size(); ++i) {
    spheres.push_back({{centers[i][0], centers[i][1], centers[i][2]}, track.radius(i)});
  }
}

}  // namespace

// The errors of the tracks (set_errors()) leave room for the rounding of distances and radii; what
// a clearance adds is a few units of itself.
bool MotionOracle::may_touch(double t, double clearance) {
  near_.place(a_, b_, t);
  for (std::size_t i = 0; i < a_.size(); ++i) {
    for (std::size_t j = 0; j < b_.size(); ++j) {
      const double limit =
          a_.radius(i) + b_.radius(j) + clearance * (1 + 0x1p-48) + a_.error(i) + b_.error(j);
      if (near_.squared_distance(i, j) <= limit * limit) return true;
    }
  }
  return false;
}

MotionOracle::Contact MotionOracle::at(double t, double clearance) {
  if (!may_touch(t, clearance)) return Contact::kNo;
  exact_.place(exact_a_, exact_b_, t);
  Contact contact = Contact::kNo;
  const long double clear = clearance;
  for (std::size_t i = 0; i < exact_a_.size(); ++i) {
    for (std::size_t j = 0; j < exact_b_.size(); ++j) {
      const long double gap = std::sqrt(exact_.squared_distance(i, j)) -
                              (static_cast<long double>(exact_a_.radius(i)) + exact_b_.radius(j));
      const long double error = exact_a_.error(i) + exact_b_.error(j) +
                                clear * 16 * std::numeric_limits<long double>::epsilon();
      if (gap <= clear - error) return Contact::kYes;
      if (gap <= clear + error) contact = Contact::kUncertain;
    }
  }
  return contact;
}

void MotionOracle::place(double t, std::vector<Sphere>& placed_a, std::vector<Sphere>& placed_b) {
  near_.place(a_, b_, t);
  add_spheres(near_.a, a_, placed_a);
  add_spheres(near_.b, b_, placed_b);
}

}  // namespace spherule
