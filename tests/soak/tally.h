// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"
#include "geometry/pose.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

namespace spherule::test {

// Exact to the bit: the numbers of a configuration, and "x y z qx qy qz qw" as `spherule collide`
// takes it.
inline std::string to_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%s%.17g", text.empty() ? "" : " ", number);
    text += buffer.data();
  }
  return text;
}

inline std::string to_text(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  const Eigen::Vector3d t = pose.translation();
  return to_text(std::array{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

// Counts the answers to one question; each fault fails the test, and the first ones say how to see
// them again.
struct Tally {
  std::string question;
  std::uint64_t cases = 0;
  std::uint64_t near = 0;  // made to be within 2 mm of contact
  std::uint64_t hits = 0;  // answers: collision, free, unknown
  std::uint64_t free = 0;
  std::uint64_t unknown = 0;
  std::uint64_t uncertain = 0;  // left open by the oracle itself
  std::uint64_t faults = 0;

  void count(Verdict verdict, bool is_near) {
    ++cases;
    near += is_near ? 1 : 0;
    ++(verdict == Verdict::kCollision ? hits : verdict == Verdict::kFree ? free : unknown);
  }

  void add_fault(const std::string& what) {
    constexpr std::uint64_t kShown = 20;
    if (++faults <= kShown) ADD_FAILURE() << question << ", case " << cases << ": " << what;
  }

  // Whether there were both answers, and cases near contact, to be judged.
  void expect_telling(std::uint64_t least_free) const {
    EXPECT_EQ(faults, 0U) << question;
    EXPECT_GT(hits, 0U) << question;
    EXPECT_GE(free, least_free) << question;
    EXPECT_GT(near, cases / 5) << question;
    EXPECT_LE(uncertain, cases / 100) << question;
  }
  void expect_telling() const { expect_telling(cases / 20 + 1); }
};

}  // namespace spherule::test
