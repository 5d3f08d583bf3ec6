// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/progress.h"

#include "cli/text/print.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iostream>
#include <optional>
#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

namespace spherule {
namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr std::chrono::seconds kLogInterval{10};
// Return to the first column and erase the line.
constexpr const char* kEraseLine = "\r\x1b[K";

constexpr std::array kInterruptions = {SIGINT, SIGTERM, SIGHUP};

// Handles the interruptions of the whole process, worker threads included, while it lives.
class InterruptionHandler {
 public:
  explicit InterruptionHandler(void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
      sigaction(kInterruptions[i], nullptr, &before_[i]);
      // What the parent has this process ignore stays ignored.
      if (before_[i].sa_handler != SIG_IGN) sigaction(kInterruptions[i], &action, nullptr);
    }
  }
  ~InterruptionHandler() {
    for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
      sigaction(kInterruptions[i], &before_[i], nullptr);
    }
  }
  InterruptionHandler(const InterruptionHandler&) = delete;
  InterruptionHandler& operator=(const InterruptionHandler&) = delete;

 private:
  std::array<struct sigaction, kInterruptions.size()> before_;
};

volatile std::sig_atomic_t signal_while_writing = 0;

void remember(int signal_number) {
  signal_while_writing = signal_number;
}

// Of the one StopOnInterruption: all that its handler may touch.
struct StopState {
  std::atomic<bool> has_answer = false;
  std::atomic<int> signal_number = 0;
  sem_t wake;
};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

StopState stop_state;

void request_stop(int signal_number) {
  if (!stop_state.has_answer || stop_state.signal_number != 0) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
    return;
  }
  stop_state.signal_number = signal_number;
  sem_post(&stop_state.wake);
}

std::optional<InterruptionHandler> stop_handler;

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

void write_uninterrupted(const std::function<void()>& write) {
  {
    signal_while_writing = 0;
    const InterruptionHandler handler(remember);
    write();
  }
  if (signal_while_writing != 0) raise(signal_while_writing);
}

StopOnInterruption::StopOnInterruption() {
  stop_state.has_answer = false;
  stop_state.signal_number = 0;
  sem_init(&stop_state.wake, 0, 0);
  watcher_ = std::jthread([this] {
    while (sem_wait(&stop_state.wake) != 0) {
    }
    if (stop_state.signal_number == 0) return;
    // Below a progress bar, where there may be one.
    if (isatty(STDERR_FILENO) == 1) std::cerr << "\n";
    tell("interrupted: what is proved so far will be written; interrupt again to end at once");
    source_.request_stop();
  });
  stop_handler.emplace(request_stop);
}

StopOnInterruption::~StopOnInterruption() {
  stop_handler.reset();
  sem_post(&stop_state.wake);
  watcher_.join();
  sem_destroy(&stop_state.wake);
  if (stop_state.signal_number == 0 || std::uncaught_exceptions() > 0) return;
  std::cout.flush();
  raise(stop_state.signal_number);
}

void StopOnInterruption::have_answer() {
  stop_state.has_answer = true;
}

}  // namespace spherule
