// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// oneTBB as far as the library uses it, for the thread sanitizer, which does not see how the
// threads of oneTBB's binary wait for each other and would report every loop. Here a loop starts a
// thread for each of its parts but the first, while fewer than kMostThreads run, and waits for
// them: two threads have nothing in common but what the library's own code shares.

#include "tests/soak/executor/tbb/blocked_range.h"
#include "tests/soak/executor/tbb/task_group.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

struct simple_partitioner {};

namespace executor {

inline constexpr int kMostThreads = 4;
inline std::atomic<int> threads = 0;

// Calls work(first, last) for parts of [begin, end).
template <class Index, class Work>
void run(Index begin, Index end, const Work& work) {
  if (!(begin < end)) return;
  const std::size_t size = static_cast<std::size_t>(end - begin);
  const std::size_t parts = std::min<std::size_t>(size, 3);
  std::exception_ptr failure;
  std::mutex mutex;
  const auto do_part = [&](std::size_t part) {
    try {
      work(static_cast<Index>(begin + static_cast<Index>(size * part / parts)),
           static_cast<Index>(begin + static_cast<Index>(size * (part + 1) / parts)));
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> started;
    for (std::size_t part = 1; part < parts; ++part) {
      if (threads.fetch_add(1, std::memory_order_relaxed) < kMostThreads) {
        started.emplace_back([&do_part, part] {
          do_part(part);
          threads.fetch_sub(1, std::memory_order_relaxed);
        });
      } else {
        threads.fetch_sub(1, std::memory_order_relaxed);
        do_part(part);
      }
    }
    do_part(0);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace executor

template <class Index, class Work>
void parallel_for(const blocked_range<Index>& range, const Work& work) {
  executor::run(range.begin(), range.end(),
                [&](Index first, Index last) { work(blocked_range<Index>(first, last)); });
}

template <class Index, class Work>
void parallel_for(const blocked_range<Index>& range, const Work& work, task_group_context&) {
  parallel_for(range, work);
}

template <class Index, class Work>
void parallel_for(Index begin, Index end, const Work& work, simple_partitioner) {
  executor::run(begin, end, [&](Index first, Index last) {
    for (Index i = first; i < last; ++i) work(i);
  });
}

}  // namespace tbb
