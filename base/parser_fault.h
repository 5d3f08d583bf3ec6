// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a parser says of a text that it refuses, without the words that are for programmers.

#include <cstddef>
#include <string>
#include <string_view>

namespace spherule::internal {

// Of what() of an exception of nlohmann::json, on one line. What was read last of the text, which
// may be long and any bytes, is left out.
std::string json_fault(std::string_view what);

// Of the name and the line of an error of tinyxml2; no line is named if it is 0.
std::string xml_fault(std::string_view error_name, int line);

// Of an XML text with a tag of more than 2^16 bytes or 256 attributes, for which parsers take time
// or memory in proportion to its square; empty if it has none. Comments, CDATA and processing
// instructions are no tags.
std::string fault_of_large_tag(std::string_view xml);

// Where the markup of an XML text ends, told without parsing it.

// Behind the end of the tag that starts at `begin`, whose values may hold what would end it; the
// size of the text if it does not end.
std::size_t end_of_tag(std::string_view xml, std::size_t begin);

// Behind the end of a comment, a CDATA section, a processing instruction or a declaration that
// starts at `begin` (the size of the text if it does not end); `begin` if none does.
std::size_t end_of_other_markup(std::string_view xml, std::size_t begin);

}  // namespace spherule::internal
