// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace spherule {

// Makes `path` a file of exactly these bytes, or leaves what was there: the bytes are written to a
// new file in the same folder, flushed to the disk, and renamed over `path`. On failure the new
// file is removed. A symbolic link is followed, also to a file that is not there yet. What exists
// and is not a regular file is refused. A process that is killed between the two steps leaves a
// file named like ".NAME.Ab12Cd", never a half-written `path`. Throws Error naming the file.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

// All bytes of a file (regular, or a pipe up to its end). Throws Error naming the file.
std::string read_file(const std::filesystem::path& path);

}  // namespace spherule
