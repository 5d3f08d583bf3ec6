// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/progress.h"

#include "cli/text/message.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace spherule {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr std::chrono::seconds kLogInterval{10};
// Return to the first column and erase the line.
constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

ProgressBar::ProgressBar()
    : on_terminal_(isatty(STDERR_FILENO) == 1), last_time_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
  clear();
}

void ProgressBar::clear() {
  const std::lock_guard lock(mutex_);
  if (drawn_) std::fputs(kEraseLine, stderr);
  drawn_ = false;
}

void ProgressBar::announce(const char* what) {
  show(-1.0, what);
}

Progress ProgressBar::callback() {
  return [this](double share, const char* what) { show(share, what); };
}

void ProgressBar::show(double share, const char* what) {
  const std::lock_guard lock(mutex_);
  on_terminal_ ? draw(share, what) : log(share, what);
}

void ProgressBar::log(double share, const char* what) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_time_ < kLogInterval) return;
  last_time_ = now;
  const std::string word = one_line(what);  // it may be the name of a link
  if (share < 0.0) {
    std::fprintf(stderr, "spherule: progress: %s\n", word.c_str());
  } else {
    std::fprintf(stderr, "spherule: progress: %s (%d %%)\n", word.c_str(),
                 static_cast<int>(std::min(share, 1.0) * 100.0));
  }
}

void ProgressBar::draw(double share, const char* what) {
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && last_what_ == what && now - last_time_ < kRedrawInterval) return;
  drawn_ = true;
  last_what_ = what;
  last_time_ = now;
  const std::string word = one_line(what);
  if (share < 0.0) {
    std::fprintf(stderr, "%s%s ...", kEraseLine, word.c_str());
    return;
  }
  const double done = std::min(share, 1.0);
  const int full = static_cast<int>(done * kBarWidth);
  const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - full), '.');
  std::fprintf(stderr, "%s[%s] %3d%% %s", kEraseLine, bar.c_str(), static_cast<int>(done * 100.0),
               word.c_str());
}

}  // namespace spherule
