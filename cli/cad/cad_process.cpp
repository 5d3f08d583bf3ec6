// SPDX-License-Identifier: BSD-3-Clause
#include "cli/cad/cad_process.h"

#include "cli/cad/cad_arguments.h"
#include "cli/cad/cad_message.h"
#include "cli/modules/module.h"
#include "spheretree/error.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <string>
#include <sys/types.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace spherule {
namespace {

constexpr double kSeconds = 30.0;
constexpr double kSecondsPerByte = 60.0 / 1e6;
constexpr double kForAChordError = 10.0;

std::string exact(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

// Of processor time.
long most_seconds(const std::filesystem::path& path, const CadReadOptions& options) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  const double seconds = kSeconds + (none ? 0.0 : kSecondsPerByte * static_cast<double>(size));
  return std::lround(options.chord_error > 0.0 ? kForAChordError * seconds : seconds);
}

// A descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

[[noreturn]] void fail(const std::string& subject, const char* what, int error) {
  throw Error(subject, std::string(what) + ": " + std::strerror(error));
}

pid_t start(const std::string& program, std::array<std::string, kCadArguments - 1> arguments,
            int answer) {
  std::array<char*, kCadArguments + 1> pointers{};
  std::string name = program;
  pointers[0] = name.data();
  for (std::size_t i = 0; i < arguments.size(); ++i) pointers[i + 1] = arguments[i].data();
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  // OpenCASCADE writes what it notices to standard output.
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, answer, kCadAnswer);
  pid_t child = 0;
  const int error =
      ::posix_spawn(&child, program.c_str(), &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) fail(program, "cannot be run", error);
  return child;
}

std::vector<std::uint8_t> read_all(int descriptor, const std::string& subject) {
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> part(std::size_t{1} << 16U);
  for (;;) {
    const ssize_t count = ::read(descriptor, part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(subject, "cannot be read", errno);
    if (count == 0) return bytes;
    bytes.insert(bytes.end(), part.begin(), part.begin() + count);
  }
}

// Throws unless the process ended well.
void wait_for(pid_t child, const std::string& subject, long seconds) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) fail(subject, "cannot be read", errno);
  }
  if (!WIFSIGNALED(status)) return;
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) {
    throw Error(subject, "takes more than " + std::to_string(seconds) +
                             " s of processor time to read: is it broken?");
  }
  if (signal == SIGINT || signal == SIGTERM) throw Error(subject, "reading was interrupted");
  throw Error(subject, std::string("OpenCASCADE cannot read it (") + ::strsignal(signal) +
                           "): is it broken?");
}

std::vector<CadBody> read_apart(const char* function, const std::filesystem::path& path,
                                const CadReadOptions& options) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(path.string(), "cannot be read", errno);
  Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  const long seconds = most_seconds(path, options);
  const pid_t child =
      start(module_path("spherule_cad").string(),
            {function, path.string(), exact(options.scale), exact(options.chord_error),
             exact(options.angle), std::to_string(seconds)},
            to_parent.number());
  to_parent.close();
  const std::vector<std::uint8_t> answer = read_all(from_child.number(), path.string());
  wait_for(child, path.string(), seconds);
  try {
    return unpacked(answer);
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    throw Error(path.string(), "OpenCASCADE ended before it was read: is it broken?");
  }
}

}  // namespace

CadPart read_cad_apart(const std::filesystem::path& path, const CadReadOptions& options) {
  return std::move(read_apart("part", path, options).at(0).part);
}

std::vector<CadBody> read_cad_bodies_apart(const std::filesystem::path& path,
                                           const CadReadOptions& options) {
  return read_apart("bodies", path, options);
}

}  // namespace spherule
