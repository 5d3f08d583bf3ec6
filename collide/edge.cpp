// SPDX-License-Identifier: BSD-3-Clause
#include "collide/edge.h"

#include "spheretree/error.h"

namespace spherule {

void require_resolution(double resolution) {
  if (!(resolution > 0.0)) throw Error("resolution", "it is not above zero");
}

}  // namespace spherule
