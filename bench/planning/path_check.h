// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/configuration.h"

#include <cstddef>
#include <vector>

namespace spherule {

struct PathCheck {
  std::size_t configurations = 0;  // examined
  std::size_t contacts = 0;        // of these, in contact
};

// Queries an engine about configurations on a path of straight motions in joint space, its corners
// included, no joint moving by more than `step` radians from one to the next.
PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step);

}  // namespace spherule
