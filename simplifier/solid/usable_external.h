// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/external_spheres.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"
#include "spheretree/sphere.h"

#include <cmath>
#include <cstddef>
#include <string>

namespace spherule::internal {

// Throws Error for external spheres that stage 1 cannot have made: those that nobody filled in,
// whose box holds nothing, and numbers that are not finite or far too large. That they are of the
// mesh beside them is not known here.
inline void check_external(const ExternalSpheres& external) {
  // Coordinates, padding and diameters of as much as is allowed add up to less.
  constexpr double kLargest = 8.0 * kMaxCoordinate;
  const auto fits = [](double number) { return std::abs(number) <= kLargest; };
  for (int axis = 0; axis < 3; ++axis) {
    const double low = external.box.min()[axis];
    const double high = external.box.max()[axis];
    if (!fits(low) || !fits(high) || low > high) {
      throw Error("external spheres", "their box is empty or not finite");
    }
  }
  if (!(external.padding >= 0.0 && fits(external.padding))) {
    throw Error("external spheres", "their padding is negative or not finite");
  }
  for (std::size_t i = 0; i < external.spheres.size(); ++i) {
    const Sphere& sphere = external.spheres[i];
    if (!fits(sphere.center.x()) || !fits(sphere.center.y()) || !fits(sphere.center.z()) ||
        !(sphere.radius >= 0.0 && fits(sphere.radius))) {
      throw Error("external spheres", "sphere " + std::to_string(i) +
                                          " is not finite, too large, or of negative radius");
    }
  }
}

}  // namespace spherule::internal
