// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/process_cases.h"
#include "tests/soak/random_scene.h"
#include "tests/support/child_process.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <sys/wait.h>
#include <thread>

namespace spherule {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

bool has_ended(pid_t process) {
  siginfo_t info = {};
  return waitid(P_PID, static_cast<id_t>(process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == process;
}

class Killer {
 public:
  Killer(const CommandFolder& folder, SceneRandom& random) : folder_(folder), random_(random) {
    folder_.put_older_files();
    const auto start = Clock::now();
    const pid_t process = folder_.start();
    while (see_next(process)) ++most_sights_;
    wait_for(process);
    whole_run_ = Clock::now() - start;
  }

  // At any moment of a run.
  void at_any_time(pid_t process) const {
    std::this_thread::sleep_for(random_.between(0.0, 1.05) * whole_run_);
    kill(process, SIGKILL);
  }

  // Once one of its files is being written, a little later. The command tries its places first,
  // which is writing, too.
  void while_writing(pid_t process) const {
    const int sights = random_.whole(1, std::max(1, most_sights_));
    const Seconds later(random_.chance(0.3) ? 0.0 : random_.magnitude(1e-6, 1e-2));
    for (int i = 0; i < sights && see_next(process); ++i) {
    }
    std::this_thread::sleep_for(later);
    kill(process, SIGKILL);
  }

 private:
  // Waits for a temporary file to come after there was none; false if the process ended before.
  bool see_next(pid_t process) const {
    while (folder_.has_temporary()) {
      if (has_ended(process)) return false;
    }
    while (!folder_.has_temporary()) {
      if (has_ended(process)) return false;
    }
    return true;
  }

  const CommandFolder& folder_;
  SceneRandom& random_;
  int most_sights_ = 0;
  Seconds whole_run_{};
};

void add_faults(SoakRecord& record, const std::string& place,
                const std::vector<std::string>& faults) {
  for (const std::string& fault : faults) record.add_fault(place + fault);
}

}  // namespace

SoakRecord check_kills(const std::filesystem::path& program, const SoakCommand& command,
                       std::uint64_t kills, std::uint64_t seed) {
  SceneRandom random(seed);
  const CommandFolder folder(program, command);
  const Killer killer(folder, random);
  SoakRecord record;
  for (; record.cases < kills; ++record.cases) {
    folder.put_older_files();
    const pid_t process = folder.start();
    const bool is_aimed = record.cases % 2 == 1;
    is_aimed ? killer.while_writing(process) : killer.at_any_time(process);
    wait_for(process);
    const std::string place = command.name + ", kill " + std::to_string(record.cases) + ": ";
    const CommandFolder::Files killed = folder.look();
    add_faults(record, place, killed.faults);
    if (killed.has_temporary || (killed.has_old && killed.has_new)) ++record.near;

    const int exit_code = wait_for(folder.start());
    const CommandFolder::Files after = folder.look();
    add_faults(record, place + "after the next run ", after.faults);
    if (exit_code != folder.exit_code()) {
      record.add_fault(place + "the next run ends with " + std::to_string(exit_code));
    }
    if (after.has_temporary) record.add_fault(place + "the next run leaves a temporary file");
    if (after.has_old) record.add_fault(place + "the next run leaves an older file");
  }
  record.answers = record.cases;
  return record;
}

}  // namespace spherule
