// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/interruption.h"

#include "cli/text/message.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <exception>
#include <iostream>
#include <optional>
#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

namespace spherule {
namespace {

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
