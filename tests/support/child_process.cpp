// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/child_process.h"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace spherule {
namespace {

void redirect(const char* file, int stream) {
  const int descriptor = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (descriptor < 0 || dup2(descriptor, stream) < 0) _exit(126);
}

}  // namespace

pid_t start_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const ChildOptions& options) {
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error(program.string() + " cannot be started");
  if (process > 0) return process;
  if (chdir(options.folder.c_str()) != 0) _exit(126);
  redirect(options.out, STDOUT_FILENO);
  redirect(options.error, STDERR_FILENO);
  for (const std::string& variable : options.environment) {
    putenv(const_cast<char*>(variable.c_str()));
  }
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) != process) {
    if (errno != EINTR) throw std::runtime_error("there is no such child process");
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace spherule
