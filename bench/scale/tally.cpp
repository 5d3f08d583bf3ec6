// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scale/tally.h"

#include <algorithm>

namespace spherule {
namespace {

constexpr int kShownFailures = 20;

}  // namespace

void Tally::count(Verdict verdict, bool is_near) {
  ++cases;
  near += is_near ? 1 : 0;
  ++(verdict == Verdict::kCollision ? hits : verdict == Verdict::kFree ? free : unknown);
}

void Tally::count_extra(long double gap, double slack) {
  ++extra;
  worst_slack = std::max(worst_slack, static_cast<double>(gap / slack));
  if (gap > slack) ++beyond;
}

Tally& ScaleReport::add(std::string question) {
  tallies_.push_back({});
  tallies_.back().question = std::move(question);
  return tallies_.back();
}

void ScaleReport::progress(std::string_view what, std::uint64_t done, std::uint64_t all) {
  const auto now = std::chrono::steady_clock::now();
  if (quiet_ || now - last_ < std::chrono::seconds(5)) return;
  last_ = now;
  std::uint64_t missed = 0, beyond = 0;
  for (const Tally& tally : tallies_) {
    missed += tally.missed;
    beyond += tally.beyond;
  }
  std::printf("%5.0f s  %.*s %llu of %llu, missed %llu, beyond %llu\n",
              std::chrono::duration<double>(now - start_).count(), static_cast<int>(what.size()),
              what.data(), static_cast<unsigned long long>(done),
              static_cast<unsigned long long>(all), static_cast<unsigned long long>(missed),
              static_cast<unsigned long long>(beyond));
  std::fflush(stdout);
}

void ScaleReport::failure(const Tally& tally, const std::string& what) {
  if (quiet_ || failures_++ >= kShownFailures) return;
  std::printf("WRONG: %s: %s\n", tally.question.c_str(), what.c_str());
  std::fflush(stdout);
}

void ScaleReport::print(std::FILE* file) const {
  std::fprintf(file, "%-26s %10s %10s %10s %10s %9s %7s %8s %11s %7s %8s\n", "question", "cases",
               "near", "hits", "free", "unknown", "missed", "extra", "worst slack", "beyond",
               "uncertain");
  for (const Tally& t : tallies_) {
    const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
    std::fprintf(file, "%-26s %10llu %10llu %10llu %10llu %9llu %7llu %8llu %11.3f %7llu %8llu\n",
                 t.question.c_str(), number(t.cases), number(t.near), number(t.hits),
                 number(t.free), number(t.unknown), number(t.missed), number(t.extra),
                 t.worst_slack, number(t.beyond), number(t.uncertain));
  }
}

bool ScaleReport::is_clean() const {
  return std::all_of(tallies_.begin(), tallies_.end(),
                     [](const Tally& t) { return t.missed == 0 && t.beyond == 0; });
}

}  // namespace spherule
