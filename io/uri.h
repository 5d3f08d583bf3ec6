// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// References of one file to others (RFC 3986, RFC 2397).

namespace spherule::internal {

// The bytes of a data URI with base64 (RFC 4648); nothing if it is none.
std::optional<std::string> bytes_of_data_uri(std::string_view uri);

// The file that a relative reference names, with percent-encoding undone; nothing if it has a
// scheme, is absolute, is not a regular file, or lies, links followed, outside of `folder`.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                std::string_view reference);

}  // namespace spherule::internal
