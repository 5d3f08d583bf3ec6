// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule::internal {

// How errors name a link.
inline std::string subject_of(const std::string& link) {
  return "link '" + link + "'";
}

}  // namespace spherule::internal
