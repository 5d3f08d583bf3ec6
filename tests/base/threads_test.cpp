// SPDX-License-Identifier: BSD-3-Clause
#include "base/threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace spherule {
namespace {

TEST(SharedWork, DoesEachPieceOnceAndLetsNoTwoShareAWorker) {
  for (const std::size_t pieces : {0U, 1U, 2U, 5U, 1000U}) {
    for (const std::size_t workers : {1U, 2U, 3U, 7U}) {
      std::vector<std::atomic<int>> done(pieces);
      std::vector<std::atomic<int>> busy(workers);
      std::atomic<bool> shared = false;
      internal::share_work(pieces, workers, [&](std::size_t worker, std::size_t piece) {
        if (busy[worker].fetch_add(1) != 0) shared = true;
        done[piece].fetch_add(1);
        busy[worker].fetch_sub(1);
      });
      for (const auto& times : done) EXPECT_EQ(times.load(), 1);
      EXPECT_FALSE(shared.load());
    }
  }
}

TEST(SharedWork, OnePieceStaysOnTheCallersThread) {
  const std::thread::id caller = std::this_thread::get_id();
  internal::share_work(1, 7, [&](std::size_t worker, std::size_t) {
    EXPECT_EQ(worker, 0U);
    EXPECT_EQ(std::this_thread::get_id(), caller);
  });
}

// Two pieces throw, now the one first, now the other.
TEST(SharedWork, ThrowsWhatTheFirstPieceThrows) {
  if (internal::thread_count() < 2) GTEST_SKIP() << "one processor runs no two pieces at once";
  for (int i = 0; i < 100; ++i) {
    std::atomic<int> begun = 0;
    std::atomic<int> thrown = 0;
    std::atomic<int> running = 0;
    const std::size_t last_to_throw = i % 2 == 0 ? 10 : 11;
    try {
      internal::share_work(100, 2, [&](std::size_t, std::size_t piece) {
        ++running;
        if (piece >= 10) ++begun;
        while (piece >= 10 && begun < 2) std::this_thread::yield();
        if (piece == last_to_throw) {
          while (thrown == 0) std::this_thread::yield();
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        --running;
        if (piece < 10) return;
        ++thrown;
        throw std::runtime_error(std::to_string(piece));
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "10");
    }
    EXPECT_EQ(running.load(), 0);
    EXPECT_EQ(thrown.load(), 2);
  }
}

}  // namespace
}  // namespace spherule
