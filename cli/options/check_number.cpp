// SPDX-License-Identifier: BSD-3-Clause
#include "cli/options/check_number.h"

#include <cmath>
#include <cstdlib>

namespace spherule {

namespace {

template <class IsGood>
std::string check(const std::string& text, const char* fault, IsGood is_good) {
  char* stop = nullptr;
  const double value = std::strtod(text.c_str(), &stop);
  if (stop == text.c_str() || *stop != '\0') return {};
  return std::isfinite(value) && is_good(value) ? "" : fault;
}

}  // namespace

std::string check_not_negative(const std::string& text) {
  return check(text, "must be finite and not negative", [](double x) { return x >= 0.0; });
}

std::string check_positive(const std::string& text) {
  return check(text, "must be finite and above 0", [](double x) { return x > 0.0; });
}

}  // namespace spherule
