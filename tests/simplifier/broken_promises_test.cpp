// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include <gtest/gtest.h>

#include <optional>

namespace spherule::test {
namespace {

Simplification fitted(bool covered, std::optional<double> protrusion, double min_radius = 0.0) {
  Simplification result;
  result.options.max_error = 2.0;
  result.options.min_radius = min_radius;
  result.certificate.covered = covered;
  result.certificate.protrusion_over_simplified_max = protrusion;
  return result;
}

bool says(const Simplification& result, const char* what) {
  return broken_promises(result).find(what) != std::string::npos;
}

TEST(BrokenPromises, AProvedFitIsNotBlamed) {
  EXPECT_EQ(broken_promises(fitted(true, 2.0)), "");
  EXPECT_EQ(broken_promises(fitted(true, 1.5, 0.5)), "");
}

TEST(BrokenPromises, ALeakIsBlamed) {
  EXPECT_TRUE(says(fitted(false, 2.0), "not proved to cover"));
  EXPECT_FALSE(says(fitted(false, 2.0), "protrude"));
  EXPECT_TRUE(says(fitted(false, 2.5), "not proved to cover"));
  EXPECT_TRUE(says(fitted(false, 2.5), "protrude"));
}

TEST(BrokenPromises, AProtrusionBeyondTheErrorIsBlamedUnlessALeastRadiusForcesIt) {
  EXPECT_TRUE(says(fitted(true, 2.0 + 1e-15), "at most 2 from the simplified solid"));
  EXPECT_TRUE(says(fitted(true, 3.5), "only by at most 3.5"));
  EXPECT_TRUE(says(fitted(true, std::nullopt), "protrude"));
  EXPECT_EQ(broken_promises(fitted(true, 3.5, 0.5)), "");
  EXPECT_TRUE(says(fitted(false, 3.5, 0.5), "not proved to cover"));
}

TEST(BrokenPromises, ALevelThatProtrudesFurtherThanItsOwnErrorIsBlamed) {
  Simplification result = fitted(true, 2.0);
  result.levels.resize(2);
  result.levels[0].max_error = result.levels[0].protrusion = 4.0;
  result.levels[1].max_error = 8.0;
  result.levels[1].protrusion = 7.5;
  EXPECT_EQ(broken_promises(result), "");
  result.levels[1].protrusion = 8.5;
  EXPECT_TRUE(says(result, "at most 8 in a level, only by at most 8.5"));
}

}  // namespace
}  // namespace spherule::test
