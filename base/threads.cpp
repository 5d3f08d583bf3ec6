// SPDX-License-Identifier: BSD-3-Clause
#include "base/threads.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace spherule::internal {

void run_in_parts(std::size_t begin, std::size_t end, const void* work,
                  void (*call)(const void* work, std::size_t first, std::size_t last)) {
  if (begin >= end) return;
  using Range = tbb::blocked_range<std::size_t>;
  // What is thrown in one loop cancels that loop alone, not those inside its other parts. Parts
  // round as the caller does, not as who started oneTBB.
  tbb::task_group_context own(tbb::task_group_context::isolated,
                              tbb::task_group_context::fp_settings);
  // A thread that waits for a loop inside another takes no part of the outer one meanwhile, whose
  // memory would come on top.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(
        Range(begin, end), [&](const Range& part) { call(work, part.begin(), part.end()); }, own);
  });
}

std::size_t thread_count() {
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(allowed, static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
}

void share_work(std::size_t pieces, std::size_t workers,
                const std::function<void(std::size_t worker, std::size_t piece)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> has_failed = false;
  std::mutex mutex;
  std::size_t first_failed = pieces;
  std::exception_ptr failure;
  // Pieces before one that threw were handed out earlier, and whoever has got one does it, so that
  // in the end the first failure is known.
  parallel_for(0, std::min(pieces, std::max<std::size_t>(workers, 1)), [&](std::size_t worker) {
    while (!has_failed) {
      const std::size_t piece = next++;
      if (piece >= pieces) return;
      try {
        work(worker, piece);
      } catch (...) {
        has_failed = true;
        const std::lock_guard lock(mutex);
        if (piece < first_failed) failure = std::current_exception();
        first_failed = std::min(first_failed, piece);
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

namespace {

// More are of no use on any machine, and tbb allocates memory for as many as it is allowed.
constexpr std::size_t kMostThreads = 4096;

std::size_t allowed_threads(int requested) {
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return requested > 0 ? std::min(static_cast<std::size_t>(requested), kMostThreads) : allowed;
}

}  // namespace

struct ThreadLimit::Control {
  explicit Control(std::size_t threads)
      : control(tbb::global_control::max_allowed_parallelism, threads) {}

  tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(std::make_unique<Control>(allowed_threads(threads))) {}

ThreadLimit::~ThreadLimit() = default;

}  // namespace spherule::internal
