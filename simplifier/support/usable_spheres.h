// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/error.h"
#include "spheretree/sphere.h"

#include <cstddef>
#include <span>
#include <string>

namespace spherule::internal {

// Throws Error for the first sphere that is not usable.
inline void check_usable(std::span<const Sphere> spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!is_usable(spheres[i])) {
      throw Error("sphere " + std::to_string(i), "not finite, too large, or of negative radius");
    }
  }
}

}  // namespace spherule::internal
