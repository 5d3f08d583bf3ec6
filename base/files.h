// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Files that appear whole or not at all.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace spherule {

// Makes `path` a file of exactly these bytes, or leaves what was there: the bytes are written to a
// new file in the same folder, flushed to the disk, and renamed over `path`. On failure the new
// file is removed. A symbolic link is followed, also to a file that is not there yet. What exists
// and is not a regular file is refused. A process that is killed between the two steps leaves a
// file named like ".NAME.spherule-Ab12Cd", never a half-written `path`; the next call for `path`
// removes it (the file of a process that runs is locked by flock() and stays). Throws Error naming
// the file. Where a limit of file sizes is set, the signal SIGXFSZ ends the process unless it is
// ignored; then that is an Error, too.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

// The file that write_file_atomically(path, ...) would replace or make: from the root on, the last
// part no symbolic link. Throws Error naming the path if it names no file that could be written.
std::filesystem::path written_file(const std::filesystem::path& path);

// Throws the Error that write_file_atomically() would throw before its first byte: for a folder
// that is missing or cannot be written to, a name that is too long, what is not a regular file. To
// be called before long work; leaves no trace but the removal of what killed processes left.
void check_writable(const std::filesystem::path& path);

// All bytes of a file (regular, or a pipe up to its end). Throws Error naming the file.
std::string read_file(const std::filesystem::path& path);

// For names that stand in other files: throws Error naming the file, before it is opened, if it is
// there and, links followed, no regular file. A pipe could be waited for without an end.
void require_regular_file(const std::filesystem::path& path);

// The path from the root on. Throws Error naming it, where it begins in the working directory and
// that is no longer there.
std::filesystem::path absolute_path(const std::filesystem::path& path);

}  // namespace spherule

// Other programs, run for what they write.

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

// What stands behind the last dot of the name, in lower case.
std::string lower_extension(const std::filesystem::path& path);

// The bytes of the file. Throws Error, naming it, if it is not a file or is empty.
std::string read_regular_file(const std::filesystem::path& path);

}  // namespace spherule::internal
