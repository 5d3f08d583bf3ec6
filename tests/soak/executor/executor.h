// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// oneTBB as far as the library uses it, for the thread sanitizer, which does not see how the
// threads of oneTBB's binary wait for each other and would report every loop. Here a loop that is
// inside no other one starts a thread for each of its parts but the first, and waits for them: two
// threads have nothing in common but what the library's own code shares.

#include <array>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace tbb {

template <class Index>
class blocked_range {
 public:
  blocked_range(Index begin, Index end, std::size_t = 1) : begin_(begin), end_(end) {}
  Index begin() const { return begin_; }
  Index end() const { return end_; }
  // A part of so many.
  blocked_range part(std::size_t i, std::size_t parts) const {
    const auto size = static_cast<std::size_t>(end_ - begin_);
    return {begin_ + static_cast<Index>(size * i / parts),
            begin_ + static_cast<Index>(size * (i + 1) / parts)};
  }

 private:
  Index begin_, end_;
};

struct simple_partitioner {};

// Loops know nothing of each other: each is isolated.
struct task_group_context {
  enum kind_type { isolated };
  enum traits_type { fp_settings };
  task_group_context(kind_type, traits_type) {}
};

// The number of threads is not limited: the results do not depend on it.
struct global_control {
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
  static std::size_t active_value(parameter) { return 4; }
};

namespace this_task_arena {

template <class Work>
void isolate(const Work& work) {
  work();
}
inline int max_concurrency() {
  return 4;
}

}  // namespace this_task_arena

namespace executor {

constexpr std::size_t kParts = 3;
inline thread_local bool is_inside = false;

// Calls work(part) for each of them.
template <class Work>
void run(const Work& work) {
  std::array<std::exception_ptr, kParts> failures;
  const auto do_part = [&](std::size_t part) {
    const bool was_inside = is_inside;
    is_inside = true;
    try {
      work(part);
    } catch (...) {
      failures[part] = std::current_exception();
    }
    is_inside = was_inside;
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t part = 1; part < kParts; ++part) {
      if (is_inside) {
        do_part(part);
      } else {
        threads.emplace_back([&do_part, part] { do_part(part); });
      }
    }
    do_part(0);
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace executor

template <class Index, class Work>
void parallel_for(const blocked_range<Index>& range, const Work& work, task_group_context&) {
  executor::run([&](std::size_t i) { work(range.part(i, executor::kParts)); });
}

template <class Index, class Work>
void parallel_for(Index begin, Index end, const Work& work, simple_partitioner) {
  executor::run([&](std::size_t part) {
    const auto range = blocked_range<Index>(begin, end).part(part, executor::kParts);
    for (Index i = range.begin(); i < range.end(); ++i) work(i);
  });
}

// The parts are joined in their order.
template <class Index, class Value, class Work, class Join>
Value parallel_deterministic_reduce(const blocked_range<Index>& range, const Value& identity,
                                    const Work& work, const Join& join) {
  std::array<Value, executor::kParts> values{identity, identity, identity};
  executor::run(
      [&](std::size_t i) { values[i] = work(range.part(i, executor::kParts), identity); });
  return join(join(values[0], values[1]), values[2]);
}

template <class Index, class Value, class Work, class Join>
Value parallel_reduce(const blocked_range<Index>& range, const Value& identity, const Work& work,
                      const Join& join) {
  return parallel_deterministic_reduce(range, identity, work, join);
}

}  // namespace tbb
