// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"

#include <chrono>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

namespace spherule {

// Tells on standard error how far long work is: by a bar, if that is a terminal; elsewhere by a
// line "spherule: progress: ..." every ten seconds, so that logs of long work are not silent, and
// short work prints nothing.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // For the `progress` field of options. It refers to this bar and may be called from any thread.
  Progress callback();

  // Shows work of which no share is known.
  void announce(const char* what);

  // Takes the bar from the terminal, before something else is printed there.
  void clear();

 private:
  void show(double share, const char* what);
  void draw(double share, const char* what);
  void log(double share, const char* what);

  bool on_terminal_ = false;
  bool drawn_ = false;
  std::mutex mutex_;
  std::string last_what_;
  // Of the last line, or of the start.
  std::chrono::steady_clock::time_point last_time_;
};

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
