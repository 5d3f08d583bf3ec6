// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <stop_token>
#include <thread>

namespace spherule {

// Runs `write`, which writes files beside their place and renames them, to its end even if the user
// interrupts, and obeys the interruption afterwards: Ctrl-C leaves no half-written file.
void write_uninterrupted(const std::function<void()>& write);

// Turns an interruption (SIGINT, SIGTERM, SIGHUP) of a long search into a request to stop, so that
// what is proved so far can be written. While it lives, and once have_answer() was called, the
// first interruption requests the stop and says so on standard error; a second one, or any before
// have_answer(), ends the process as usual. One at a time in a process.
class StopOnInterruption {
 public:
  StopOnInterruption();
  // Obeys an interruption that came: ends the process by its signal, so that a script stops, unless
  // an exception is on its way.
  ~StopOnInterruption();
  StopOnInterruption(const StopOnInterruption&) = delete;
  StopOnInterruption& operator=(const StopOnInterruption&) = delete;

  // For the `stop` field of options.
  std::stop_token token() const { return source_.get_token(); }

  // From now on there is something to write. From any thread.
  void have_answer();

 private:
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace spherule
