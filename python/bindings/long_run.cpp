// SPDX-License-Identifier: BSD-3-Clause
#include "python/bindings/long_run.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

namespace spherule::python {
namespace {

using namespace std::chrono_literals;

// Thrown through the library where it reports progress.
struct Interrupted {};

// What the two threads share.
class Run {
 public:
  // On the thread of the work.
  void work(const std::function<void(const LongRun&)>& work) {
    std::exception_ptr error;
    try {
      work({[this](double share, const char* what) { report(share, what); }, stop_.get_token()});
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    error_ = error;
    is_done_ = true;
    ended_.notify_all();
  }

  // On the thread that waits: whether the work ended within that time.
  bool wait(std::chrono::milliseconds time) {
    const WithoutLock unlocked;
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return is_done_; });
  }

  void interrupt() {
    is_interrupted_ = true;
    stop_.request_stop();
  }

  // Calls `progress` if there is something new.
  void tell(const py::object& progress) {
    if (progress.is_none()) return;
    double share = 0.0;
    std::string what;
    {
      const std::lock_guard lock(mutex_);
      if (!has_news_) return;
      has_news_ = false;
      share = share_;
      what = what_;
    }
    progress(share < 0.0 ? py::object(py::none()) : py::float_(share), what);
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  void report(double share, const char* what) {
    if (is_interrupted_) throw Interrupted();
    const std::lock_guard lock(mutex_);
    share_ = share;
    what_ = what;
    has_news_ = true;
  }

  std::atomic<bool> is_interrupted_ = false;
  std::stop_source stop_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_done_ = false;
  std::exception_ptr error_;
  bool has_news_ = false;
  double share_ = -1.0;
  std::string what_;
};

}  // namespace

void run_beside(const py::object& progress, std::function<void(const LongRun&)> work) {
  const auto run = std::make_shared<Run>();
  std::thread worker([run, work = std::move(work)] { run->work(work); });
  try {
    while (!run->wait(50ms)) {
      run->tell(progress);
      require_no_signal();
    }
    run->tell(progress);
  } catch (...) {
    run->interrupt();
    if (run->wait(500ms)) {
      worker.join();
    } else {
      worker.detach();
    }
    throw;
  }
  worker.join();
  run->rethrow();
}

void require_no_signal() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

}  // namespace spherule::python
