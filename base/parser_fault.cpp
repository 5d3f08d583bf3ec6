// SPDX-License-Identifier: BSD-3-Clause
#include "base/parser_fault.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace spherule::internal {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kXmlFaults{{
    {"XML_ERROR_PARSING_ELEMENT", "a tag is not complete"},
    {"XML_ERROR_PARSING_ATTRIBUTE",
     "an attribute is there twice, or not written as name=\"value\""},
    {"XML_ERROR_PARSING_TEXT", "a text has no tag after it"},
    {"XML_ERROR_PARSING_CDATA", "a CDATA section is not ended"},
    {"XML_ERROR_PARSING_COMMENT", "a comment is not ended"},
    {"XML_ERROR_PARSING_DECLARATION", "a declaration is not ended, or not at the beginning"},
    {"XML_ERROR_PARSING_UNKNOWN", "a tag that begins with <! is not ended"},
    {"XML_ERROR_EMPTY_DOCUMENT", "nothing is in it"},
    {"XML_ERROR_MISMATCHED_ELEMENT", "an element is not closed, or by the tag of another"},
}};

// Removes what is before the end of `mark`, and returns it; nothing if the mark is not there.
std::string_view take_to(std::string_view& text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return {};
  const std::string_view taken = text.substr(0, at + mark.size());
  text.remove_prefix(taken.size());
  return taken;
}

// How many equals signs stand outside of quotes.
std::ptrdiff_t attributes_of(std::string_view tag) {
  std::ptrdiff_t count = 0;
  std::size_t at = 0;
  while ((at = tag.find_first_of("=\"'", at)) < tag.size()) {
    if (tag[at] == '=') {
      ++count;
    } else {
      at = std::min(tag.find(tag[at], at + 1), tag.size() - 1);
    }
    ++at;
  }
  return count;
}

}  // namespace

std::string json_fault(std::string_view what) {
  if (what.starts_with("[json.exception.")) take_to(what, "] ");
  std::string place;
  constexpr std::string_view kPlace = "parse error at ";
  if (what.starts_with(kPlace)) {
    what.remove_prefix(kPlace.size());
    place = take_to(what, ": ");
  }
  if (what.starts_with("syntax error while ")) take_to(what, " - ");
  what = what.substr(0, what.find("; last read: "));
  // A number that is out of range stands in the message, however long it is.
  constexpr std::size_t kLongest = 60;
  if (what.size() > kLongest) what = what.substr(0, what.find(" parsing '"));
  return place + "is not JSON: " + std::string(what);
}

std::string xml_fault(std::string_view error_name, int line) {
  std::string text = line > 0 ? "line " + std::to_string(line) + ": " : "";
  if (error_name == "XML_ELEMENT_DEPTH_EXCEEDED") return text + "elements are nested too deep";
  text += "is not XML";
  const auto known = std::find_if(kXmlFaults.begin(), kXmlFaults.end(),
                                  [&](const auto& fault) { return fault.first == error_name; });
  if (known != kXmlFaults.end()) text.append(": ").append(known->second);
  return text;
}

std::string fault_of_large_tag(std::string_view xml) {
  constexpr std::size_t kMaxSize = std::size_t{1} << 16;
  constexpr std::ptrdiff_t kMaxAttributes = 256;
  std::size_t at = 0;
  while ((at = xml.find('<', at)) < xml.size()) {
    const std::size_t begin = at;
    at = end_of_other_markup(xml, begin);
    if (at != begin) continue;
    at = end_of_tag(xml, begin);
    const bool is_closed = xml[at - 1] == '>';
    const std::string_view tag = xml.substr(begin, at - begin - (is_closed ? 1 : 0));
    if (tag.size() <= kMaxSize && attributes_of(tag) <= kMaxAttributes) continue;
    const auto line = 1 + std::ranges::count(xml.substr(0, begin), '\n');
    return "line " + std::to_string(line) + ": a tag of more than 2^16 bytes or 256 attributes";
  }
  return {};
}

std::size_t end_of_tag(std::string_view xml, std::size_t begin) {
  char quote = 0;
  for (std::size_t at = begin; at < xml.size(); ++at) {
    if (quote != 0) {
      if (xml[at] == quote) quote = 0;
    } else if (xml[at] == '"' || xml[at] == '\'') {
      quote = xml[at];
    } else if (xml[at] == '>') {
      return at + 1;
    }
  }
  return xml.size();
}

std::size_t end_of_other_markup(std::string_view xml, std::size_t begin) {
  constexpr std::pair<std::string_view, std::string_view> kOthers[] = {
      {"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}, {"<!", ">"}};
  for (const auto& [start, stop] : kOthers) {
    if (!xml.substr(begin).starts_with(start)) continue;
    const std::size_t found = xml.find(stop, begin + start.size());
    return found == std::string_view::npos ? xml.size() : found + stop.size();
  }
  return begin;
}

}  // namespace spherule::internal
