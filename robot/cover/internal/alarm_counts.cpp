// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/alarm_counts.h"

#include "robot/model/internal/shared_work.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

double median_gap(const AlarmSample& sample, std::size_t pair, const PostureSet& alarms,
                  const FalseAlarmOptions& options) {
  std::vector<std::size_t> postures;
  alarms.for_each([&](std::size_t i) {
    if (postures.size() < options.gaps) postures.push_back(i);
  });
  if (postures.empty()) return PairAlarms{}.median_gap;
  std::vector<double> gaps(postures.size());
  share_work(gaps.size(), thread_count(options.threads),
             [&](std::size_t, std::size_t i) { gaps[i] = sample.gap(pair, postures[i]); });
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

void sort_pairs(std::vector<PairAlarms>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const PairAlarms& a, const PairAlarms& b) {
    return std::tuple(b.refused, a.first, a.second) < std::tuple(a.refused, b.first, b.second);
  });
}

}  // namespace

void add(const FalseAlarms& other, FalseAlarms& sum) {
  sum.postures += other.postures;
  sum.free += other.free;
  sum.always_touching = other.always_touching;
  for (std::size_t i = 0; i < sum.refused.size(); ++i) sum.refused[i] += other.refused[i];
  for (const PairAlarms& pair : other.pairs) {
    const auto known = std::find_if(sum.pairs.begin(), sum.pairs.end(), [&](const PairAlarms& one) {
      return one.first == pair.first && one.second == pair.second;
    });
    if (known == sum.pairs.end()) {
      sum.pairs.push_back(pair);
      continue;
    }
    known->refused += pair.refused;
    known->refused_alone += pair.refused_alone;
  }
  sort_pairs(sum.pairs);
}

FalseAlarms count_alarms(const AlarmJudge& judge, const AlarmSample& sample, const LinkTrees& trees,
                         const FalseAlarmOptions& options) {
  FalseAlarms result{.postures = sample.postures(),
                     .free = sample.free(),
                     .proofs = options.proofs,
                     .always_touching = judge.always_touching()};
  std::array<PostureSet, 3> refused;
  refused.fill(PostureSet(sample.free()));
  PostureSet once(sample.free());  // by the proofs that blame pairs
  std::vector<PostureSet> alarms;
  PostureSet seen(sample.free());
  for (std::size_t pair = 0; pair < judge.pairs().size(); ++pair) {
    const TestedPair& tested = judge.pairs()[pair];
    const PostureSet all = sample.overlaps(pair, trees[static_cast<std::size_t>(tested.first)],
                                           trees[static_cast<std::size_t>(tested.second)],
                                           sample.open(pair, PairProofs::kNone));
    for (const PairProofs with : {PairProofs::kNone, PairProofs::kNever, PairProofs::kBoxes}) {
      PostureSet open = sample.open(pair, with);
      open &= all;
      refused[static_cast<std::size_t>(with)] |= open;
      if (with != options.proofs) continue;
      PostureSet again = open;
      again &= seen;
      once |= open;
      once -= again;
      seen |= open;
      alarms.push_back(std::move(open));
    }
  }
  for (std::size_t i = 0; i < refused.size(); ++i) result.refused[i] = refused[i].size();
  for (std::size_t pair = 0; pair < alarms.size(); ++pair) {
    const std::size_t count = alarms[pair].size();
    if (count == 0) continue;
    const double gap = median_gap(sample, pair, alarms[pair], options);
    alarms[pair] &= once;
    result.pairs.push_back(
        {judge.pairs()[pair].first, judge.pairs()[pair].second, count, alarms[pair].size(), gap});
  }
  sort_pairs(result.pairs);
  return result;
}

}  // namespace spherule::internal
