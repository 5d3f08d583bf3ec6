// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"

#include <cstddef>
#include <string>

namespace spherule::internal {

inline void check_threads(int threads) {
  if (threads < 0) throw Error("threads", "must not be negative");
}

// How many points are sampled of what `subject` names.
inline void check_samples(const char* subject, std::size_t count, std::size_t least = 1) {
  if (count < least || count > 10'000'000) {
    throw Error(subject, "must be " + std::to_string(least) + " to 10000000");
  }
}

}  // namespace spherule::internal
