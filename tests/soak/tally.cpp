// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/tally.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <utility>

namespace spherule {
namespace {

constexpr std::size_t kKeptFaults = 20;

}  // namespace

void Tally::count(Verdict verdict, bool is_near) {
  ++cases;
  near += is_near ? 1 : 0;
  ++(verdict == Verdict::kCollision ? hits : verdict == Verdict::kFree ? free : unknown);
}

bool Tally::count_extra(long double gap, double slack) {
  ++extra;
  worst_slack = std::max(worst_slack, static_cast<double>(gap / slack));
  return gap > slack;
}

Tally& SoakReport::add(std::string question) {
  tallies_.push_back({});
  tallies_.back().question = std::move(question);
  return tallies_.back();
}

void SoakReport::add_fault(Tally& tally, Fault fault, const std::string& what) {
  ++(fault == Fault::kMissed    ? tally.missed
     : fault == Fault::kCrossed ? tally.crossed
                                : tally.other);
  if (faults_.size() < kKeptFaults) {
    faults_.push_back(tally.question + ", case " + std::to_string(tally.cases) + ": " + what);
  }
}

std::string to_text(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers) {
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%s%.17g", text.empty() ? "" : " ", number);
    text += buffer.data();
  }
  return text;
}

std::string to_text(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  const Eigen::Vector3d t = pose.translation();
  return to_text(std::array{t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()});
}

}  // namespace spherule
