// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace spherule::internal {

// Runs `call(work, first, last)` for parts of [begin, end) that together are all of it.
void run_in_parts(std::size_t begin, std::size_t end, const void* work,
                  void (*call)(const void* work, std::size_t first, std::size_t last));

// Over how many threads at most: those that a ThreadLimit leaves.
std::size_t thread_count();
// How many threads an option requires, of which 0 means all.
inline std::size_t thread_count(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads) : thread_count();
}

// Runs `work(i)` for every index of [begin, end), over the threads that a ThreadLimit leaves, in no
// order. What one of them throws is thrown when the others are done or left out; a loop inside a
// `work(i)` is whole unless something is thrown in that loop itself. Without the headers of oneTBB,
// which cost each source half a second to compile.
template <class Work>
void parallel_for(std::size_t begin, std::size_t end, const Work& work) {
  run_in_parts(begin, end, &work, [](const void* all, std::size_t first, std::size_t last) {
    const Work& call = *static_cast<const Work*>(all);
    for (std::size_t i = first; i < last; ++i) call(i);
  });
}

// Calls `work(worker, piece)` once for each piece 0, 1, ... pieces - 1, by at most so many workers
// at a time; no two calls share a worker at the same time. Pieces are handed out in their order, to
// whoever is free, and a single one to the caller.
//
// If a call throws, no further pieces are handed out; once all threads have ended, the exception of
// the first piece that threw is thrown on: the one that doing the pieces in their order would meet.
void share_work(std::size_t pieces, std::size_t workers,
                const std::function<void(std::size_t worker, std::size_t piece)>& work);

// While it lives, parallel loops use at most `threads` threads; 0 leaves the limit as it is.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<const Control> control_;
};

}  // namespace spherule::internal
