// SPDX-License-Identifier: BSD-3-Clause
#include "bench/fit_parts.h"

#include "base/error.h"

#include <gtest/gtest.h>

namespace spherule {
namespace {

TEST(FitParts, StopsWhereAPromiseIsNotProved) {
  Simplification fit;
  Certificate& certificate = fit.certificate;
  certificate.covered = true;
  fit.options.max_error = 2.0;
  certificate.protrusion_over_simplified_max = 2.0;
  EXPECT_NO_THROW(check_promises(fit, "part"));
  fit.options.max_error = 1.9;
  EXPECT_THROW(check_promises(fit, "part"), Error);
  fit.options.max_error = 2.0;
  certificate.protrusion_over_simplified_max.reset();
  EXPECT_THROW(check_promises(fit, "part"), Error);
  certificate.protrusion_over_simplified_max = 1.0;
  certificate.covered = false;
  EXPECT_THROW(check_promises(fit, "part"), Error);
}

}  // namespace
}  // namespace spherule
