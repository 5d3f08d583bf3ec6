// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// See parallel_for.h.
namespace tbb::this_task_arena {

template <class Work>
void isolate(const Work& work) {
  work();
}

inline int max_concurrency() {
  return 4;
}

}  // namespace tbb::this_task_arena
