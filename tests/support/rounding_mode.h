// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <string>

namespace spherule::test {

// The mode of this thread while it lives.
class Rounding {
 public:
  explicit Rounding(int mode) : old_(std::fegetround()) { std::fesetround(mode); }
  Rounding(const Rounding&) = delete;
  Rounding& operator=(const Rounding&) = delete;
  ~Rounding() { std::fesetround(old_); }

 private:
  int old_;
};

// Expects that the call is refused in every mode but rounding to nearest, and only there.
template <typename Call>
void expect_rounding_to_nearest_is_needed(Call call, const char* what) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    std::string subject = "accepted";
    try {
      const Rounding rounding(mode);
      call();
    } catch (const Error& error) {
      subject = error.subject();
    }
    EXPECT_EQ(subject, mode == FE_TONEAREST ? "accepted" : "rounding mode") << what << ' ' << mode;
  }
}

}  // namespace spherule::test
