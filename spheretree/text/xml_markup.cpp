// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/text/xml_markup.h"

#include <utility>

namespace spherule::internal {

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
