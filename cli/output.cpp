// SPDX-License-Identifier: BSD-3-Clause
#include "cli/output.h"

#include "spheretree/error.h"

#include <array>
#include <csignal>
#include <set>
#include <signal.h>
#include <system_error>

namespace spherule {
namespace {

namespace fs = std::filesystem;

constexpr std::array kInterruptions = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t pending_signal = 0;

void remember(int signal_number) {
  pending_signal = signal_number;
}

// Holds back the interruptions of the whole process, worker threads included, while it lives.
class HoldInterruptions {
 public:
  HoldInterruptions() {
    pending_signal = 0;
    struct sigaction hold = {};
    hold.sa_handler = remember;
    hold.sa_flags = SA_RESTART;
    for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
      sigaction(kInterruptions[i], &hold, &before_[i]);
    }
  }
  ~HoldInterruptions() {
    for (std::size_t i = 0; i < kInterruptions.size(); ++i) {
      sigaction(kInterruptions[i], &before_[i], nullptr);
    }
    if (pending_signal != 0) raise(pending_signal);
  }
  HoldInterruptions(const HoldInterruptions&) = delete;
  HoldInterruptions& operator=(const HoldInterruptions&) = delete;

 private:
  std::array<struct sigaction, kInterruptions.size()> before_;
};

fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path), error);
  return error ? fs::absolute(path).lexically_normal() : place;
}

}  // namespace

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  std::set<fs::path> taken;
  for (const fs::path& input : inputs) {
    if (!input.empty()) taken.insert(place_of(input));
  }
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    std::error_code error;
    const fs::path folder = fs::absolute(output).parent_path();
    if (!fs::is_directory(folder, error))
      throw Error(output.string(), "no such folder; make it first");
    if (fs::is_directory(output, error)) throw Error(output.string(), "is a folder");
    if (!taken.insert(place_of(output)).second) {
      throw Error(output.string(), "is named twice, as input or output");
    }
  }
}

void write_uninterrupted(const std::function<void()>& write) {
  const HoldInterruptions hold;
  write();
}

}  // namespace spherule
