// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where the markup of an XML text ends, told without parsing it.

#include <cstddef>
#include <string_view>

namespace spherule::internal {

// Behind the end of the tag that starts at `begin`, whose values may hold what would end it; the
// size of the text if it does not end.
std::size_t end_of_tag(std::string_view xml, std::size_t begin);

// Behind the end of a comment, a CDATA section, a processing instruction or a declaration that
// starts at `begin` (the size of the text if it does not end); `begin` if none does.
std::size_t end_of_other_markup(std::string_view xml, std::size_t begin);

}  // namespace spherule::internal
