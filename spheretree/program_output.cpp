// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/program_output.h"

#include "spheretree/error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace spherule::internal {
namespace {

// A pipe whose ends other programs that are started meanwhile do not have, at once where the system
// can make it so.
bool make_pipe(std::array<int, 2>& ends) {
#ifdef __linux__
  return ::pipe2(ends.data(), O_CLOEXEC) == 0;
#else
  if (::pipe(ends.data()) != 0) return false;
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return true;
#endif
}

// Both ends are closed with it.
class Pipe {
 public:
  explicit Pipe(const std::string& program) {
    if (!make_pipe(ends_)) {
      throw Error(program, std::string("cannot be run: ") + std::strerror(errno));
    }
  }
  ~Pipe() {
    ::close(ends_[0]);
    close_writing();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int writing() const { return ends_[1]; }
  void close_writing() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }

  std::string read_all() const {
    std::string bytes;
    std::vector<char> part(std::size_t{1} << 16U);
    for (;;) {
      const ssize_t count = ::read(ends_[0], part.data(), part.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return bytes;
      bytes.append(part.data(), static_cast<std::size_t>(count));
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

// A program that runs. It is ended with this object, unless that waited for its end.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (is_waited_for_) return;
    ::kill(id_, SIGKILL);
    int status = 0;
    wait_for_end(status);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // How it ended, as waitpid() says; false if that is not known.
  bool wait_for_end(int& status) {
    pid_t found = 0;
    do {
      found = ::waitpid(id_, &status, 0);
    } while (found < 0 && errno == EINTR);
    is_waited_for_ = true;
    return found == id_;
  }

 private:
  pid_t id_;
  bool is_waited_for_ = false;
};

}  // namespace

ProgramOutput run_program(const std::string& program, std::span<const std::string> arguments,
                          int descriptor) {
  // posix_spawn() takes them as C does, and writes to none of them.
  std::vector<char*> pointers{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) {
    pointers.push_back(const_cast<char*>(argument.c_str()));
  }
  pointers.push_back(nullptr);
  Pipe pipe(program);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  // In this order, as the pipe may be standard output where that was closed. Where it is the
  // descriptor already, posix_spawn() keeps it open.
  ::posix_spawn_file_actions_adddup2(&actions, pipe.writing(), descriptor);
  if (descriptor != STDOUT_FILENO) {
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  }
  pid_t id = 0;
  const int error =
      ::posix_spawnp(&id, program.c_str(), &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ProgramOutput result;
  if (error != 0) {
    result.not_started = std::strerror(error);
    return result;
  }
  Child child(id);
  pipe.close_writing();
  result.bytes = pipe.read_all();
  if (!child.wait_for_end(result.status)) throw Error(program, "it is not known how it ended");
  return result;
}

}  // namespace spherule::internal
