// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/xacro.h"

#include "spheretree/atomic_file.h"
#include "spheretree/error.h"
#include "spheretree/program_output.h"

#include <array>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace spherule::internal {

bool is_xacro(const std::filesystem::path& path) {
  return path.extension() == ".xacro";
}

std::string urdf_text(const std::filesystem::path& path) {
  if (!is_xacro(path)) return read_file(path);
  const std::string file = path.string();
  // So that a name that begins with a dash is no option.
  const std::array<std::string, 1> arguments = {path.is_relative() ? "./" + file : file};
  ProgramOutput output = run_program("xacro", arguments, STDOUT_FILENO);
  if (!output.not_started.empty()) {
    throw Error(file, "needs the program xacro, which makes a URDF of it and cannot be run: " +
                          output.not_started);
  }
  if (WIFSIGNALED(output.status)) throw Error(file, "xacro was ended by a signal");
  if (WEXITSTATUS(output.status) != 0) {
    throw Error(file, "xacro makes no URDF of it (exit code " +
                          std::to_string(WEXITSTATUS(output.status)) + ")");
  }
  return std::move(output.bytes);
}

}  // namespace spherule::internal
