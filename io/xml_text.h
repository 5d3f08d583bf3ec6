// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <tinyxml2.h>

namespace spherule::internal {

// Parses an XML text in UTF-8 into the document and returns its root. Throws Error, naming file and
// line, for what is not well-formed, for elements nested more than 100 deep, a large tag
// (fault_of_large_tag()), more than one root, and a document type: it may define entities, and no
// format that is read here has one.
const tinyxml2::XMLElement& parse_xml(tinyxml2::XMLDocument& document, std::string_view text,
                                      const std::string& subject);

}  // namespace spherule::internal
