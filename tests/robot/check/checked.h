// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace spherule::test {

using Configuration = std::vector<double>;

// A checker with a scratch of its own.
struct Checked {
  explicit Checked(const RobotChecker& of) : checker(of), scratch(checker) {}
  explicit Checked(const RobotScene& scene, const RobotCheckerOptions& options = {})
      : Checked(scene.snapshot(options)) {}

  bool free(std::span<const double> q) { return checker.check_config(q, scratch); }
  // All at once.
  std::vector<std::uint8_t> free(std::span<const double> configurations, std::size_t count) {
    std::vector<std::uint8_t> result(count, 2);
    checker.check_configs(configurations, scratch, result);
    return result;
  }
  std::vector<CheckedContact> explain(std::span<const double> q,
                                      const ExplainRequest& request = {}) {
    return checker.explain(q, scratch, request);
  }
  RobotClearance clearance(std::span<const double> q, const ClearanceRequest& request = {}) {
    return checker.clearance(q, scratch, request);
  }
  EdgeResult edge(const Configuration& from, const Configuration& to,
                  const EdgeRequest& request = {}) {
    return checker.check_edge(from, to, scratch, request);
  }

  RobotChecker checker;
  RobotChecker::Scratch scratch;
};

struct VerdictCounts {
  int free = 0;
  int hits = 0;
  int unknown = 0;

  void count(Verdict verdict) {
    (verdict == Verdict::kFree ? free : verdict == Verdict::kCollision ? hits : unknown) += 1;
  }
};

inline Configuration on_the_way(const Configuration& from, const Configuration& to, double t) {
  Configuration at;
  for (std::size_t i = 0; i < from.size(); ++i) at.push_back((1.0 - t) * from[i] + t * to[i]);
  return at;
}

inline Configuration moved(Configuration from, const Configuration& by) {
  for (std::size_t i = 0; i < from.size(); ++i) from[i] += by[i];
  return from;
}

// What a result says has to be so at every one of `steps` configurations, and where it ends:
// hits(configuration) says whether there is a contact.
template <class Hits>
void expect_so(Hits hits, const Configuration& from, const Configuration& to,
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

// With a scratch that remembers nothing.
inline void expect_so(const RobotChecker& checker, const Configuration& from,
                      const Configuration& to, const EdgeResult& result, int steps) {
  Checked fresh(checker);
  expect_so([&](const Configuration& at) { return !fresh.free(at); }, from, to, result, steps);
}

}  // namespace spherule::test
