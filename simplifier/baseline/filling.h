// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Which cells of space a method takes.
enum class Filling {
  kSolid,   // those that the surface intersects and those inside
  kSurface  // those that the surface intersects
};

}  // namespace spherule
