// SPDX-License-Identifier: BSD-3-Clause
#include "bench/fit_parts.h"

#include "spheretree/error.h"

#include <gtest/gtest.h>

namespace spherule {
namespace {

TEST(FitParts, StopsWhereAPromiseIsNotProved) {
  Certificate certificate;
  certificate.covered = true;
  certificate.protrusion_over_simplified_max = 2.0;
  EXPECT_NO_THROW(check_promises(certificate, 2.0, "part"));
  EXPECT_THROW(check_promises(certificate, 1.9, "part"), Error);
  certificate.protrusion_over_simplified_max.reset();
  EXPECT_THROW(check_promises(certificate, 2.0, "part"), Error);
  certificate.protrusion_over_simplified_max = 1.0;
  certificate.covered = false;
  EXPECT_THROW(check_promises(certificate, 2.0, "part"), Error);
}

}  // namespace
}  // namespace spherule
