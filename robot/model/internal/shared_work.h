// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

namespace spherule::internal {

// How many threads an option requires, of which 0 means all.
std::size_t thread_count(int threads);

// Calls `work(worker, piece)` once for each piece 0, 1, ... piece_count - 1, on up to worker_count
// threads, of which the caller's is worker 0; no two calls share a worker at the same time. Pieces
// are handed out in their order, to whoever is free; no more threads are started than pieces, and
// where the system gives fewer, these do all the work.
//
// If a call throws, no further pieces are handed out; once all threads have ended, the exception of
// the first piece that threw is thrown on: the one that doing the pieces in their order would meet.
void share_work(std::size_t piece_count, std::size_t worker_count,
                const std::function<void(std::size_t worker, std::size_t piece)>& work);

}  // namespace spherule::internal
