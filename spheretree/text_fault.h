// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where a text that a parser refuses breaks the rules of JSON or XML, and how, in plain words: what
// parsers say of it is made for programmers.
//
// @code{.cpp}
// #include <spherule/spheretree/text_fault.h>
// #include <cassert>
//
// using namespace spherule::internal;
// assert(json_fault("{\"a\": 1}").empty());
// assert(json_fault("{\"a\": 1,}") == "line 1, column 9: is not JSON: a comma before '}'");
// assert(xml_fault("<a></b>") == "line 1, column 4: is not XML: </b> where </a> is due");
// @endcode

#include <cstddef>
#include <string>
#include <string_view>

namespace spherule::internal {

// "line 2, column 7" of a place in a text, both counted from 1, columns in characters of UTF-8.
std::string place_in(std::string_view text, std::size_t at);

// The first fault of a text that is not JSON, on one line, as above; empty for JSON without numbers
// beyond the range of a double, whose objects and arrays are nested at most 1000 deep.
std::string json_fault(std::string_view text);

// The first fault of a text that is not XML, as far as tags, attributes, comments and their like
// are concerned; empty where none is found. Entities and document types are not examined.
std::string xml_fault(std::string_view text);

}  // namespace spherule::internal
