// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a parser says of a text that it refuses, without the words that are for programmers.
//
// @code{.cpp}
// #include <spherule/spheretree/parser_fault.h>
// #include <cassert>
//
// using namespace spherule::internal;
// assert(json_fault("[json.exception.parse_error.101] parse error at line 1, column 9: syntax "
//                   "error while parsing object key - unexpected '}'; expected string literal") ==
//        "line 1, column 9: is not JSON: unexpected '}'; expected string literal");
// assert(xml_fault("XML_ERROR_EMPTY_DOCUMENT", 0) == "is not XML: nothing is in it");
// assert(fault_of_large_tag("<robot name='r'/>").empty());
// @endcode

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

}  // namespace spherule::internal
