// SPDX-License-Identifier: BSD-3-Clause
#include "base/parser_fault.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using internal::fault_of_large_tag;
using internal::json_fault;
using internal::xml_fault;

std::string fault_of(const std::string& text) {
  try {
    const auto parsed = nlohmann::json::parse(text);
    ADD_FAILURE() << parsed;
  } catch (const nlohmann::json::exception& error) {
    return json_fault(error.what());
  }
  return "";
}

TEST(ParserFault, OfJsonHasNoWordsForProgrammers) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1, column 1: is not JSON: unexpected end of input"},
      {"{\"a\": [1,\n 2 3]}", "line 2, column 4: is not JSON: unexpected number literal"},
      {"{\"a\": 1,}", "line 1, column 9: is not JSON: unexpected '}'; expected string literal"},
      {"[NaN]", "line 1, column 2: is not JSON: invalid literal"},
      {"[\"a\tb\"]", "is not JSON: invalid string: control character U+0009 (HT) must be escaped"},
      {"[\"\xFF\"]", "is not JSON: invalid string: ill-formed UTF-8 byte"},
      {"[1e999]", "is not JSON: number overflow parsing '1e999'"},
      {"{} {}", "line 1, column 4: is not JSON: unexpected '{'; expected end of input"}};
  for (const auto& [text, expected] : cases) {
    const std::string fault = fault_of(text);
    EXPECT_NE(fault.find(expected), std::string::npos) << fault;
    EXPECT_EQ(fault.starts_with("line"), expected.find("overflow") == std::string::npos) << fault;
    for (const char* theirs : {"json.exception", "syntax error", "parse error", "last read"}) {
      EXPECT_EQ(fault.find(theirs), std::string::npos) << fault;
    }
  }
  // As long as it likes, or in no form that is known: it stays as it is.
  EXPECT_LT(fault_of("[\"" + std::string(100000, 'x')).size(), 100U);
  EXPECT_LT(fault_of("[1" + std::string(100000, '0') + "]").size(), 100U);
  EXPECT_EQ(json_fault("other words"), "is not JSON: other words");
}

TEST(ParserFault, OfXmlNamesTheLine) {
  EXPECT_EQ(xml_fault("XML_ERROR_MISMATCHED_ELEMENT", 3),
            "line 3: is not XML: an element is not closed, or by the tag of another");
  EXPECT_EQ(xml_fault("XML_ERROR_EMPTY_DOCUMENT", 0), "is not XML: nothing is in it");
  EXPECT_EQ(xml_fault("XML_ELEMENT_DEPTH_EXCEEDED", 1), "line 1: elements are nested too deep");
  EXPECT_EQ(xml_fault("XML_ERROR_OF_LATER_VERSIONS", 2), "line 2: is not XML");
}

// Texts of which a large tag is no tag, and tags that are just large enough.
TEST(ParserFault, OfLargeTags) {
  const auto attributes = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += " a" + std::to_string(i) + "='='";
    return text;
  };
  const std::string many = attributes(257);
  const std::string blanks(1 << 16, ' ');
  for (const std::string& good :
       {"<a" + attributes(256) + "/>", "<!--<a" + many + "-->", "<![CDATA[<a" + many + "]]>",
        "<?a" + many + "?>", "<!x \"><a/>" + many, "<a b=\"" + many + "\"/>",
        "<a" + blanks.substr(2) + ">", std::string("<"), std::string()}) {
    EXPECT_EQ(fault_of_large_tag(good), "") << good.substr(0, 20);
  }
  const std::string fault = "line 2: a tag of more than 2^16 bytes or 256 attributes";
  for (const std::string& bad : {"\n<a" + many + "/>", "\n<a" + many, "\n<a" + blanks + ">",
                                 "<!-- <a>\n--><b" + many + ">", "<!x '>\n<a" + many + "'>"}) {
    EXPECT_EQ(fault_of_large_tag(bad), fault) << bad.substr(0, 20);
  }
}

}  // namespace
}  // namespace spherule
