// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/external_spheres.h"

#include <chrono>
#include <mutex>
#include <string>

namespace spherule {

// A progress bar on standard error, if that is a terminal; nothing at all elsewhere.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // For the `progress` field of options; empty where nothing would be shown. It refers to this bar
  // and may be called from any thread.
  Progress callback();

  // Shows work of which no share is known.
  void announce(const char* what);

  // Takes the bar from the terminal, before something else is printed there.
  void clear();

 private:
  void show(double share, const char* what);

  bool on_terminal_ = false;
  bool drawn_ = false;
  std::mutex mutex_;
  std::string last_what_;
  std::chrono::steady_clock::time_point last_time_;
};

}  // namespace spherule
