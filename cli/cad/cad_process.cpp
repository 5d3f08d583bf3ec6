// SPDX-License-Identifier: BSD-3-Clause
#include "cli/cad/cad_process.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/cad/cad_message.h"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <utility>

namespace spherule {
namespace {

constexpr double kSeconds = 30.0;
constexpr double kSecondsPerByte = 60.0 / 1e6;
constexpr double kForAChordError = 10.0;

// The reader stands where SPHERULE_MODULE_FOLDER leads from the folder of the command, so that the
// prefix may be moved.
std::filesystem::path reader_path() {
  const std::filesystem::path command = std::filesystem::read_symlink("/proc/self/exe");
  return (command.parent_path() / SPHERULE_MODULE_FOLDER / "spherule_cad").lexically_normal();
}

// Of processor time.
long most_seconds(const std::filesystem::path& path, const CadReadOptions& options) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  const double seconds = kSeconds + (none ? 0.0 : kSecondsPerByte * static_cast<double>(size));
  return std::lround(options.chord_error > 0.0 ? kForAChordError * seconds : seconds);
}

// Throws if the process was ended by a signal, or could not load its libraries.
void check_end(const internal::ProgramOutput& output, const std::string& program,
               const std::string& subject, long seconds) {
  constexpr int kNoLibrary = 127;  // of the loader
  if (WIFEXITED(output.status) && WEXITSTATUS(output.status) == kNoLibrary) {
    throw Error(program, "cannot be run");
  }
  if (!WIFSIGNALED(output.status)) return;
  const int signal = WTERMSIG(output.status);
  if (signal == SIGXCPU) {
    throw Error(subject, "takes more than " + std::to_string(seconds) +
                             " s of processor time to read: is it broken?");
  }
  if (signal == SIGKILL) {
    throw Error(subject, "reading was killed: is there enough memory, or is it broken?");
  }
  if (signal == SIGINT || signal == SIGTERM) throw Error(subject, "reading was interrupted");
  throw Error(subject, std::string("OpenCASCADE cannot read it (") + ::strsignal(signal) +
                           "): is it broken?");
}

std::vector<CadBody> read_apart(const char* function, const std::filesystem::path& path,
                                const CadReadOptions& options) {
  const std::string program = reader_path().string();
  const long seconds = most_seconds(path, options);
  const std::array<std::string, kCadArguments - 1> arguments = {
      function,
      path.string(),
      internal::number_text(options.scale),
      internal::number_text(options.chord_error),
      internal::number_text(options.angle),
      std::to_string(seconds)};
  const internal::ProgramOutput output = internal::run_program(program, arguments, kCadAnswer);
  if (!output.not_started.empty()) throw Error(program, "cannot be run: " + output.not_started);
  check_end(output, program, path.string(), seconds);
  try {
    return unpacked(output.bytes);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
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
