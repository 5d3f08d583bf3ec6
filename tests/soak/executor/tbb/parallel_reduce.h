// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/soak/executor/tbb/parallel_for.h"

// See parallel_for.h. Both halve a range as oneTBB's deterministic one does, so that sums are the
// same whichever thread is first.
namespace tbb {

template <class Index, class Value, class Work, class Join>
Value parallel_deterministic_reduce(const blocked_range<Index>& range, const Value& identity,
                                    const Work& work, const Join& join) {
  if (!range.is_divisible()) return work(range, identity);
  const Index middle = range.begin() + (range.end() - range.begin()) / 2;
  Value halves[2] = {identity, identity};
  executor::run(0, 2, [&](int first, int last) {
    for (int i = first; i < last; ++i) {
      const auto half = i == 0 ? blocked_range<Index>(range.begin(), middle, range.grainsize())
                               : blocked_range<Index>(middle, range.end(), range.grainsize());
      halves[i] = parallel_deterministic_reduce(half, identity, work, join);
    }
  });
  return join(halves[0], halves[1]);
}

template <class Index, class Value, class Work, class Join>
Value parallel_reduce(const blocked_range<Index>& range, const Value& identity, const Work& work,
                      const Join& join) {
  const std::size_t size = static_cast<std::size_t>(range.end() - range.begin());
  return parallel_deterministic_reduce(
      blocked_range<Index>(range.begin(), range.end(), size / 8 + 1), identity, work, join);
}

}  // namespace tbb
