// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace spherule::internal {

// No member of an archive may unpack to more than this.
inline constexpr std::size_t kMaxMemberSize = std::size_t{1} << 29;

// The content of one file of a ZIP archive (ZIP64 too; stored or deflated). Upper and lower case of
// ASCII letters in `name` are one, as in the names of OPC packages. The size that the archive
// declares is believed only as far as the packed bytes can yield it, and the checksum must be
// right. Throws Error: not an archive, no such member or several, encrypted, packed in another way,
// damaged, too large.
std::string read_zip_member(std::string_view archive, std::string_view name,
                            const std::string& subject);

}  // namespace spherule::internal
