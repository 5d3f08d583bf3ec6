// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace spherule::test
