// SPDX-License-Identifier: BSD-3-Clause
// The program that reads one CAD file for the command (cad_process.h).
#include "base/error.h"
#include "base/text.h"
#include "cli/cad/cad_message.h"
#include "io/cad/cad_file.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace spherule {
namespace {

// Of an argument that the command wrote.
double number(std::string_view text) {
  const std::optional<double> value = internal::finite_number(text);
  if (!value) std::exit(EXIT_FAILURE);
  return *value;
}

// The signal that ends a process at this limit leaves no file of its memory behind.
void limit(double seconds) {
  const auto most = static_cast<rlim_t>(seconds);
  struct rlimit limits = {};
  ::signal(SIGXCPU, SIG_DFL);
  if (::getrlimit(RLIMIT_CPU, &limits) == 0 && limits.rlim_cur > most) {
    limits.rlim_cur = most;
    ::setrlimit(RLIMIT_CPU, &limits);
  }
  const struct rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

std::string answer(const std::string& function, const std::string& path,
                   const CadReadOptions& options) {
  try {
    if (function == "bodies") return packed(read_cad_bodies(path, options));
    const CadBody body{.name = "", .part = read_cad(path, options)};
    return packed({&body, 1});
  } catch (const Error& error) {
    return packed_error(error.subject(), error.reason());
  } catch (const std::bad_alloc&) {
    return packed_error(path, "there is not enough memory to read it");
  }
}

bool write_all(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(kCadAnswer, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  using namespace spherule;
  if (argc != kCadArguments) return EXIT_FAILURE;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit(number(argv[6]));
  const CadReadOptions options = {
      .scale = number(argv[3]), .chord_error = number(argv[4]), .angle = number(argv[5])};
  return write_all(answer(argv[1], argv[2], options)) ? EXIT_SUCCESS : EXIT_FAILURE;
}
