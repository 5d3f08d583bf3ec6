// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace spherule {

// How a program is run: in which folder, in which files there its standard output and error go, and
// with which variables (NAME=VALUE) beside those of this process.
struct ChildOptions {
  std::filesystem::path folder;
  const char* out;
  const char* error;
  std::vector<std::string> environment = {};
};

// Starts a program. Throws std::runtime_error if there can be no further process; a program that
// cannot be run ends with exit code 126 or 127.
pid_t start_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const ChildOptions& options);

// Waits for it: its exit code, or the signal that ended it, negative. Throws std::runtime_error for
// what is no child of this process.
int wait_for(pid_t process);

}  // namespace spherule
