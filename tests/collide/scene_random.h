// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The old name of tests/support/random.h.
#include "tests/support/random.h"

namespace spherule::test {

class SceneRandom : public Random {
 public:
  using Random::Random;
  double uniform(double low, double high) { return between(low, high); }
};

}  // namespace spherule::test
