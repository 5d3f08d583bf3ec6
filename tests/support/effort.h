// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherule::test {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

// A number of cases: sanitizers make each several times as slow, so that they get fewer.
constexpr int effort(int cases, int under_sanitizers) {
  return kSanitized ? under_sanitizers : cases;
}

// Why a test is skipped under them: it takes too long there, and others run the same code.
inline constexpr const char* kLeftToRelease = "takes long; the release run does it";

// The same of a list of them, the most telling first.
template <class Case>
std::vector<Case> effort(std::vector<Case> cases, std::size_t under_sanitizers) {
  if (kSanitized) cases.resize(std::min(cases.size(), under_sanitizers));
  return cases;
}

}  // namespace spherule::test
