// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/sweep.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace spherule::test {

inline std::vector<double> on_the_way(const std::vector<double>& from,
                                      const std::vector<double>& to, double t) {
  std::vector<double> at;
  for (std::size_t i = 0; i < from.size(); ++i) at.push_back((1.0 - t) * from[i] + t * to[i]);
  return at;
}

// What a result says has to be so at every one of `steps` configurations, and where it ends:
// hits(configuration) says whether there is a contact.
template <class Hits>
void expect_so(Hits hits, const std::vector<double>& from, const std::vector<double>& to,
               const EdgeResult& result, int steps) {
  const auto hits_at = [&](double t) { return hits(on_the_way(from, to, t)); };
  if (result.verdict == Verdict::kFree) {
    EXPECT_EQ(result.free_until, 1.0);
    EXPECT_FALSE(hits_at(1.0));
  }
  for (int i = 0; i < steps && result.free_until > 0.0; ++i) {
    const double t = result.free_until * (static_cast<double>(i) / steps);
    ASSERT_FALSE(hits_at(t)) << t << " of " << result.free_until;
  }
  if (result.verdict == Verdict::kCollision) {
    EXPECT_TRUE(hits_at(result.contact_at)) << result.contact_at;
    EXPECT_LE(result.free_until, result.contact_at);
  } else {
    EXPECT_EQ(result.contact_at, std::numeric_limits<double>::infinity());
  }
}

}  // namespace spherule::test
