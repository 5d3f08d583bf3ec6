// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/progress.h"

#include <chrono>
#include <mutex>
#include <string>

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

}  // namespace spherule
