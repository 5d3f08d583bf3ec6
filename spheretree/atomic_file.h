// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Files that appear whole or not at all.
//
// @code{.cpp}
// #include <spherule/spheretree/atomic_file.h>
// #include <cassert>
// #include <filesystem>
//
// const auto path = std::filesystem::temp_directory_path() / "spherule_example.txt";
// spherule::check_writable(path);  // before long work
// spherule::write_file_atomically(path, "all of it\n");
// assert(spherule::read_file(path) == "all of it\n");
// @endcode

#include <filesystem>
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
