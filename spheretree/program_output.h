// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Other programs, run for what they write.
//
// @code{.cpp}
// #include <spherule/spheretree/program_output.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<std::string> words{"a", "b"};
// const auto output = spherule::internal::run_program("echo", words, 1);
// assert(output.status == 0 && output.bytes == "a b\n");
// @endcode

#include <span>
#include <string>

namespace spherule::internal {

// How a program ran.
struct ProgramOutput {
  std::string bytes{};      // what it wrote
  int status = 0;           // how it ended, as waitpid() says
  std::string not_started;  // why it could not be run; otherwise empty
};

// Runs a program, looked for on the PATH unless its name has a slash, with these arguments, until
// it ends, and returns what it writes to `descriptor`: to its standard output (1), or to another (3
// or above), and standard output is discarded. Standard input and error are those of this process.
// May be called from several threads. Throws Error where there can be no pipe, and where it is not
// known how the program ended (SIGCHLD is ignored); std::bad_alloc where its output takes more
// memory than there is. The program itself is
// not left behind in any case; what it started may be.
ProgramOutput run_program(const std::string& program, std::span<const std::string> arguments,
                          int descriptor);

}  // namespace spherule::internal
