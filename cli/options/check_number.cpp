// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/check_number.h"

#include <cmath>
#include <cstdlib>

namespace spherule {

std::string check_not_negative(const std::string& text) {
  char* stop = nullptr;
  const double value = std::strtod(text.c_str(), &stop);
  if (stop == text.c_str() || *stop != '\0') return {};
  return std::isfinite(value) && value >= 0.0 ? "" : "must be finite and not negative";
}

}  // namespace spherule
