// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/collide.h"

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <string>
#include <string_view>

namespace spherule {

// What one question was answered, and what was true.
struct Tally {
  std::string question;
  std::uint64_t cases = 0;
  std::uint64_t near = 0;  // made to be within 2 mm of contact
  std::uint64_t hits = 0;  // answers: collision, free, unknown
  std::uint64_t free = 0;
  std::uint64_t unknown = 0;
  std::uint64_t missed = 0;     // called free (or bounded) against the truth
  std::uint64_t extra = 0;      // called a collision where none was found
  double worst_slack = 0.0;     // largest gap of those, as a share of what is promised
  std::uint64_t beyond = 0;     // gap larger than promised, or another answer than it must be
  std::uint64_t uncertain = 0;  // left open by the oracle itself

  void count(Verdict verdict, bool is_near);
  // A collision was reported where the exact gap is `gap`, with `slack` promised.
  void count_extra(long double gap, double slack);
};

// Collects the tallies and shows how far the work is.
class ScaleReport {
 public:
  explicit ScaleReport(bool quiet) : quiet_(quiet) {}

  // Stays where it is.
  Tally& add(std::string question);

  // Prints a line every few seconds.
  void progress(std::string_view what, std::uint64_t done, std::uint64_t all);
  // Prints the first few of what went wrong.
  void failure(const Tally& tally, const std::string& what);

  void print(std::FILE* file) const;
  bool is_clean() const;  // nothing missed, nothing beyond what is promised
  const std::deque<Tally>& tallies() const { return tallies_; }

 private:
  bool quiet_;
  std::deque<Tally> tallies_;
  int failures_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = start_;
};

}  // namespace spherule
