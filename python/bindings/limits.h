// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Limits of queries, and what they found.

#include "collide/collide.h"
#include "spheretree/error.h"

#include <chrono>
#include <cstdint>
#include <limits>
#include <pybind11/pybind11.h>

namespace spherule::python {

// None is no limit.
inline std::uint64_t count_of(pybind11::handle value, const char* name) {
  if (value.is_none()) return std::numeric_limits<std::uint64_t>::max();
  try {
    return value.cast<std::uint64_t>();
  } catch (const pybind11::cast_error&) {
    throw pybind11::type_error(std::string(name) + ": it is neither a whole number nor None");
  }
}

// Seconds, of which too many are no limit.
inline std::chrono::nanoseconds time_of(double seconds) {
  if (!(seconds >= 0.0)) throw Error("max_seconds", "it is not 0 or more");
  if (seconds > 1e9) return std::chrono::nanoseconds::max();
  return std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

// A member of the package's Verdict.
pybind11::object verdict_of(Verdict verdict);

}  // namespace spherule::python
