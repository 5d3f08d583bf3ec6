// SPDX-License-Identifier: BSD-3-Clause
#include "io/xml_text.h"

#include "base/error.h"
#include "base/parser_fault.h"

namespace spherule::internal {

const tinyxml2::XMLElement& parse_xml(tinyxml2::XMLDocument& document, std::string_view text,
                                      const std::string& subject) {
  const std::string_view start = text.substr(0, 2);
  if (start == "\xFE\xFF" || start == "\xFF\xFE" || start.find('\0') != std::string_view::npos) {
    throw Error(subject, "is not XML in UTF-8 (UTF-16 is not supported)");
  }
  // The parser would end there.
  if (text.find('\0') != std::string_view::npos) throw Error(subject, "XML with a zero byte");
  const std::string large = fault_of_large_tag(text);
  if (!large.empty()) throw Error(subject, large);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(subject, xml_fault(document.ErrorName(), document.ErrorLineNum()));
  }
  const tinyxml2::XMLElement* root = nullptr;
  for (const auto* at = document.FirstChild(); at != nullptr; at = at->NextSibling()) {
    const auto fail = [&](const char* reason) {
      throw Error(subject, "line " + std::to_string(at->GetLineNum()) + ": " + reason);
    };
    if (at->ToUnknown() != nullptr) fail("XML with a document type");
    if (at->ToText() != nullptr) fail("is not XML: text outside of the root element");
    if (at->ToElement() == nullptr) continue;
    if (root != nullptr) fail("is not XML: it has more than one root element");
    root = at->ToElement();
  }
  if (root == nullptr) throw Error(subject, "is not XML: nothing is in it");
  return *root;
}

}  // namespace spherule::internal
