// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/shared_work.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// What the workers share. Pieces before one that threw were handed out earlier, and whoever has got
// one does it, so that in the end the first failure is known.
class Pieces {
 public:
  Pieces(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work)
      : count_(count), first_failure_(count), work_(work) {}

  void run(std::size_t worker) noexcept {
    while (!failed_.load(std::memory_order_relaxed)) {
      const std::size_t piece = next_.fetch_add(1, std::memory_order_relaxed);
      if (piece >= count_) return;
      try {
        work_(worker, piece);
      } catch (...) {
        fail(piece, std::current_exception());
        return;
      }
    }
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void fail(std::size_t piece, std::exception_ptr failure) {
    failed_.store(true, std::memory_order_relaxed);
    const std::lock_guard lock(mutex_);
    if (piece >= first_failure_) return;
    first_failure_ = piece;
    failure_ = std::move(failure);
  }

  const std::size_t count_;
  std::size_t first_failure_;
  const std::function<void(std::size_t, std::size_t)>& work_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

std::size_t thread_count(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads)
                     : std::max(1U, std::thread::hardware_concurrency());
}

void share_work(std::size_t piece_count, std::size_t worker_count,
                const std::function<void(std::size_t worker, std::size_t piece)>& work) {
  Pieces pieces(piece_count, work);
  {
    std::vector<std::jthread> threads;
    const std::size_t count = std::min(worker_count, piece_count);
    threads.reserve(count);
    try {
      for (std::size_t worker = 1; worker < count; ++worker) {
        threads.emplace_back([&pieces, worker] { pieces.run(worker); });
      }
    } catch (const std::system_error&) {
      // No more threads are to be had: those there are do the work.
    }
    pieces.run(0);
  }
  pieces.rethrow();
}

}  // namespace spherule::internal
