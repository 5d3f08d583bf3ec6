// SPDX-License-Identifier: BSD-3-Clause
// A search that is told to stop ends with what it has proved.
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <stop_token>
#include <vector>

namespace spherule::test {
namespace {

class CoverStop : public testing::Test {
 protected:
  CoverStop() : mesh_(l_bracket()) {
    options_.max_error = (kSanitized ? 0.12 : 0.05) * diagonal_of(mesh_);
    external_ = place_external_spheres(mesh_, {.min_external_diameter = 4.0 * options_.max_error,
                                               .max_error = options_.max_error});
  }

  void expect_covered(const SphereCover& cover) const {
    EXPECT_TRUE(certify(mesh_, cover.spheres, {.external = &external_}).covered);
  }

  TriangleMesh mesh_;
  ExternalSpheres external_;
  CoverOptions options_;
};

TEST_F(CoverStop, RequestedBeforehandGivesTheFirstAnswer) {
  options_.effort = 0;
  const SphereCover first = cover(mesh_, external_, options_);
  std::stop_source stop;
  stop.request_stop();
  options_.stop = stop.get_token();
  options_.effort = std::numeric_limits<int>::max();
  options_.lower_bound = true;
  const SphereCover stopped = cover(mesh_, external_, options_);
  EXPECT_EQ(stopped.spheres, first.spheres);
  EXPECT_EQ(stopped.lower_bound, 0U);
  expect_covered(stopped);
}

// The request comes with the second answer: the search would go on for hours.
TEST_F(CoverStop, EndsWithTheAnswerThatWasProvedLast) {
  std::stop_source stop;
  std::vector<std::size_t> counts;
  options_.stop = stop.get_token();
  options_.effort = std::numeric_limits<int>::max();
  options_.on_proved = [&](std::size_t count) {
    counts.push_back(count);
    if (counts.size() == 2) stop.request_stop();
  };
  const SphereCover stopped = cover(mesh_, external_, options_);
  ASSERT_EQ(counts.size(), 2U);
  EXPECT_LT(counts[1], counts[0]);
  EXPECT_EQ(stopped.spheres.size(), counts[1]);
  expect_covered(stopped);
}

}  // namespace
}  // namespace spherule::test
