// SPDX-License-Identifier: BSD-3-Clause
#include "collide/search/single_precision.h"

#include <cmath>
#include <limits>

namespace spherule::internal {

[[gnu::noinline]] double in_single_precision(double x) {
  return static_cast<double>(static_cast<float>(x));
}

float rounded_up_to_single(double x) {
  const double nearest = in_single_precision(x);
  const auto result = static_cast<float>(nearest);
  return nearest >= x ? result : std::nextafter(result, std::numeric_limits<float>::infinity());
}

}  // namespace spherule::internal
