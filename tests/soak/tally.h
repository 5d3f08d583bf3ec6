// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"
#include "geometry/pose.h"

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// What one question was answered, and what was true.
struct Tally {
  std::string question;
  std::uint64_t cases = 0;
  std::uint64_t near = 0;  // made to be within 2 mm of contact
  std::uint64_t hits = 0;  // answers: collision, free, unknown
  std::uint64_t free = 0;
  std::uint64_t unknown = 0;
  std::uint64_t missed = 0;     // called free against the truth
  std::uint64_t crossed = 0;    // a bound against the truth, or a gap beyond the slack
  std::uint64_t other = 0;      // another answer than it must be
  std::uint64_t extra = 0;      // called a collision where none was found
  double worst_slack = 0.0;     // largest gap of those, as a share of what is promised
  std::uint64_t uncertain = 0;  // left open by the oracle itself

  void count(Verdict verdict, bool is_near);
  // A collision was reported where the exact gap is `gap`, with `slack` promised. Whether it is
  // larger than that.
  bool count_extra(long double gap, double slack);
};

enum class Fault { kMissed, kCrossed, kOther };

// Collects the tallies, and says of the first faults how to see them again.
class SoakReport {
 public:
  // Stays where it is.
  Tally& add(std::string question);

  void add_fault(Tally& tally, Fault fault, const std::string& what);

  const std::deque<Tally>& tallies() const { return tallies_; }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  std::deque<Tally> tallies_;
  std::vector<std::string> faults_;
};

// Exact to the bit: the numbers of a configuration, and "x y z qx qy qz qw" as `spherule collide`
// takes it.
std::string to_text(std::span<const double> numbers);
std::string to_text(const Pose& pose);

}  // namespace spherule
