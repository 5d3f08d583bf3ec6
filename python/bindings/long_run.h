// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Work beside the interpreter: without its lock, and so that Ctrl-C ends it.

#include "spheretree/progress.h"

#include <functional>
#include <memory>
#include <optional>
#include <pybind11/pybind11.h>
#include <stop_token>
#include <utility>

namespace spherule::python {

namespace py = pybind11;

// Releases the interpreter's lock for a scope that touches nothing of Python. Cheaper than
// pybind11's, which serves threads that Python does not know, too.
class WithoutLock {
 public:
  WithoutLock() : state_(PyEval_SaveThread()) {}
  ~WithoutLock() { PyEval_RestoreThread(state_); }
  WithoutLock(const WithoutLock&) = delete;
  WithoutLock& operator=(const WithoutLock&) = delete;

 private:
  PyThreadState* state_;
};

// What long work is given: it reports to `progress`, and may look at `stop`.
struct LongRun {
  Progress progress;
  std::stop_token stop;
};

// Runs `work` on a thread of its own while this one waits without the lock. Twenty times a second
// it calls `progress` (None, or called with the share that is done or None, and a word) with what
// the work reported last, and looks for signals: where a handler raises, as that of Ctrl-C does, or
// `progress` does, the work is told to stop and left alone if it does not do so within half a
// second: its next report of progress ends it. So `work` must own all that it uses, and nothing of
// Python's.
void run_beside(const py::object& progress, std::function<void(const LongRun&)> work);

// The same with a result.
template <class Work>
auto run_long(const py::object& progress, Work work) {
  using Result = decltype(work(std::declval<const LongRun&>()));
  const auto result = std::make_shared<std::optional<Result>>();
  run_beside(progress, [work = std::move(work), result](const LongRun& run) mutable {
    result->emplace(work(run));
  });
  return std::move(**result);
}

// Throws what a signal's handler raised while the lock was not held: to be called now and then.
void require_no_signal();

}  // namespace spherule::python
