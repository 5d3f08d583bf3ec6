// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <string>
#include <vector>

namespace spherule {

// The balls of one link, in the frame of the link, in metres.
struct LinkSpheres {
  std::string link;
  std::vector<Sphere> spheres;
};

}  // namespace spherule
