// SPDX-License-Identifier: BSD-3-Clause
#include "base/moved_from.h"

#include "base/error.h"

namespace spherule::internal {

void fail_moved_from(const char* type) {
  throw Error(type, "its content was moved to another object");
}

}  // namespace spherule::internal
