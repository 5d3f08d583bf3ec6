// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The old name of this header.
#include "tests/support/exact/shapes.h"

namespace spherule::test {
using Digits50 = Real;
}  // namespace spherule::test
