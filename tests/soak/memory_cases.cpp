// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/process_cases.h"
#include "tests/support/child_process.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : " / ") + line;
  return all;
}

class MemoryCheck {
 public:
  MemoryCheck(const fs::path& program, const fs::path& failing_new, const SoakCommand& command)
      : folder_(program, command), failing_new_(failing_new), name_(command.name) {}

  // Whether the allocation came to pass.
  bool run(std::uint64_t allocation, SoakRecord& record) {
    folder_.put_older_files();
    const fs::path mark = folder_.path() / "failed";
    fs::remove(mark);
    const int exit_code =
        wait_for(folder_.start({"LD_PRELOAD=" + failing_new_.string(),
                                "SPHERULE_SOAK_ALLOCATION=" + std::to_string(allocation),
                                "SPHERULE_SOAK_MARK=" + mark.string()}));
    if (!fs::exists(mark)) return false;
    ++record.cases;
    judge(name_ + ", allocation " + std::to_string(allocation) + ": ", exit_code, record);
    return true;
  }

 private:
  void judge(const std::string& place, int exit_code, SoakRecord& record) {
    const std::vector<std::string> messages = folder_.messages();
    if (exit_code == 2 && messages == std::vector<std::string>{"spherule: out of memory"}) {
      ++record.near;
    } else if (exit_code != folder_.exit_code()) {
      record.add_fault(place + "ends with " + std::to_string(exit_code) + ": " + joined(messages));
    }
    const CommandFolder::Files files = folder_.look();
    for (const std::string& fault : files.faults) record.add_fault(place + fault);
    if (exit_code == folder_.exit_code() && files.has_old) {
      record.add_fault(place + "did not write all files");
    }
    if (files.has_temporary) record.add_fault(place + "leaves a temporary file");
  }

  CommandFolder folder_;
  fs::path failing_new_;
  std::string name_;
};

}  // namespace

SoakRecord check_memory(const fs::path& program, const fs::path& failing_new,
                        const SoakCommand& command, const FailingAllocations& failing) {
  MemoryCheck check(program, failing_new, command);
  SoakRecord record;
  for (std::uint64_t i = 0; i < failing.runs && !record.is_last; ++i) {
    record.is_last = !check.run(failing.first + i * failing.step, record);
  }
  record.answers = record.cases;
  return record;
}

}  // namespace spherule
