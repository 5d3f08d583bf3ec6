// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace spherule {

// The parts of the soak in which a command is run: one that writes nothing is not killed, and of
// those that share most of their code one runs out of memory.
enum class CommandPart { kKills, kMemory, kBoth };

// A call of the command in a folder where `in/` has what it reads, and all that it writes comes
// into `out/`.
struct SoakCommand {
  std::string name;
  std::vector<std::string> arguments;
  CommandPart part = CommandPart::kBoth;
};

// Each kind of file that a command writes, and the main commands.
const std::vector<SoakCommand>& soak_commands();

// A folder for one of them, removed at the end.
class CommandFolder {
 public:
  // Runs `program`; the first run, which must succeed, tells what is written.
  CommandFolder(std::filesystem::path program, const SoakCommand& command);
  ~CommandFolder();
  CommandFolder(const CommandFolder&) = delete;
  CommandFolder& operator=(const CommandFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  // Starts it with these variables in its environment; wait_for() waits for it. What it prints on
  // standard error is in its messages.
  pid_t start(const std::vector<std::string>& environment = {}) const;
  // Without warnings.
  std::vector<std::string> messages() const;
  int exit_code() const { return exit_code_; }  // of the first run

  // Puts older files where the command writes, and removes all others.
  void put_older_files() const;

  // How the files are: all old, or all new, or some of each; anything else is a fault.
  struct Files {
    bool has_temporary = false;
    bool has_old = false;
    bool has_new = false;
    std::vector<std::string> faults{};
  };
  Files look() const;
  // The same of temporary files alone, quickly.
  bool has_temporary() const;

 private:
  bool is_new(const std::string& name, const std::string& bytes) const;

  std::filesystem::path program_, path_;
  std::vector<std::string> arguments_;
  int exit_code_ = 0;
  std::map<std::string, std::string> written_;
};

}  // namespace spherule
