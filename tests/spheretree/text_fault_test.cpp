// SPDX-License-Identifier: BSD-3-Clause
// Faults of JSON and XML: whether there is one is compared with a parser.
#include "spheretree/text_fault.h"

#include "tests/spheretree/spheres.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {
namespace {

using internal::json_fault;
using internal::xml_fault;

struct Case {
  std::string text;
  std::string fault;
};

TEST(TextFault, OfJsonIsToldInPlainWords) {
  const std::vector<Case> cases = {
      {"", "line 1, column 1: is not JSON: nothing is in it"},
      {"{\"a\": [1,\n 2 3]}", "line 2, column 4: is not JSON: a comma or ']' is missing"},
      {"{\"a\": 1 \"b\": 2}", "line 1, column 9: is not JSON: a comma or '}' is missing"},
      {"{\"a\": 1,}", "line 1, column 9: is not JSON: a comma before '}'"},
      {"{\"a\": [1}", "line 1, column 9: is not JSON: a comma or ']' is missing"},
      {"\n{\"a\": [1",
       "line 2, column 9: is not JSON: it ends before the '[' of line 2, column 7 is closed"},
      {"{'a': 1}", "line 1, column 2: is not JSON: texts stand in double quotes"},
      {"{a: 1}", "line 1, column 2: is not JSON: a key in double quotes is due"},
      {"{\"a\" 1}", "line 1, column 6: is not JSON: a colon after the key is missing"},
      {"{\"\xC3\xA9\": ]}", "line 1, column 7: is not JSON: ']' where a value is due"},
      {"[NaN]", "line 1, column 2: is not JSON: 'NaN' is not a value of JSON"},
      {"[-Infinity]", "line 1, column 2: is not JSON: infinity is not a number of JSON"},
      {"[01]", "line 1, column 2: is not JSON: a number begins with a needless 0"},
      {"[1.]", "line 1, column 2: is not JSON: a number is not complete"},
      {"[1e999]", "line 1, column 2: is not JSON: the number '1e999' is too large"},
      {"[\"a\tb\"]", "line 1, column 4: is not JSON: a tab in a text is written as \\t"},
      {"[\"a]",
       "line 1, column 2: is not JSON: a text begins here that is not ended by a double quote"},
      {"[\"\\q\"]", "line 1, column 3: is not JSON: a backslash in a text is written as \\\\"},
      {"[\"\xFF\"]", "line 1, column 3: is not JSON: a text is not valid UTF-8"},
      {"// x\n{}", "line 1, column 1: is not JSON: comments are not allowed"},
      {"{} {}", "line 1, column 4: is not JSON: something follows after its end"},
  };
  for (const Case& one : cases) EXPECT_EQ(json_fault(one.text), one.fault) << one.text;
}

// Texts of pieces of JSON, most of which are faulty.
TEST(TextFault, OfJsonIsFoundWhereAParserFindsOne) {
  const std::vector<std::string> pieces = {"{",
                                           "}",
                                           "[",
                                           "]",
                                           ",",
                                           ":",
                                           "\"a\"",
                                           "\"b\": 1",
                                           "1",
                                           "-0.5e+3",
                                           "0",
                                           "1e-400",
                                           "true",
                                           "null",
                                           " ",
                                           "\n",
                                           "\"\\u00e9\\ud83d\\ude00\"",
                                           "\"\\ud800\"",
                                           "\"\xF0\x9F\x98\x80\"",
                                           "\"\xED\xA0\x80\"",
                                           "-",
                                           ".",
                                           "e",
                                           "\"",
                                           "\\",
                                           "\xC3",
                                           "\t",
                                           "nul",
                                           "/"};
  test::Random random(5);
  int good = 0;
  for (int round = 0; round < test::effort(40000, 10000); ++round) {
    std::string text;
    for (std::size_t i = 1 + random.below(8); i > 0; --i)
      text += pieces[random.below(pieces.size())];
    const bool is_json = nlohmann::json::accept(text);
    good += is_json ? 1 : 0;
    ASSERT_EQ(json_fault(text).empty(), is_json) << text << "\n" << json_fault(text);
    ASSERT_EQ(json_fault(text).find('\n'), std::string::npos);
  }
  EXPECT_GT(good, 50);
}

// One byte of a good text is replaced.
TEST(TextFault, OfJsonAfterAMutationIsFoundWhereAParserFindsOne) {
  const std::string whole =
      R"({"format": "x", "n": [1, -2.5e3, 0], "s": "\u00e9\n", "o": {"t": true, "z": null, "e": {}}})";
  ASSERT_EQ(json_fault(whole), "");
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string text = whole;
      text[at] = static_cast<char>(byte);
      ASSERT_EQ(json_fault(text).empty(), nlohmann::json::accept(text)) << text;
    }
    EXPECT_NE(json_fault(whole.substr(0, at)), "") << at;
  }
}

TEST(TextFault, OfXmlIsToldInPlainWords) {
  const std::vector<Case> cases = {
      {"", "line 1, column 1: is not XML: nothing is in it"},
      {"hello", "line 1, column 1: is not XML: a text where a tag is due"},
      {"<a>\n <b>\n</a>", "line 3, column 1: is not XML: </a> where </b> is due, opened in line 2"},
      {"<a><b></c></a>", "line 1, column 7: is not XML: </c> where </b> is due"},
      {"<a>\n <b>",
       "line 2, column 5: is not XML: it ends before <b> of line 2, column 2 is closed"},
      {"<a/></a>", "line 1, column 5: is not XML: </a> closes nothing"},
      {"<a/>\n<b/>", "line 2, column 1: is not XML: a second element after the end of the first"},
      {"<a b='1' b='2'/>", "line 1, column 10: is not XML: the attribute 'b' is there twice"},
      {"<a b=1/>", "line 1, column 6: is not XML: the value of the attribute 'b' is not in quotes"},
      {"<a b/>", "line 1, column 4: is not XML: the attribute 'b' has no value"},
      {"<a b=\"1>\n<c/></a>",
       "line 1, column 6: is not XML: the value of the attribute 'b' is not ended by \""},
      {"<a b='1'c='2'/>",
       "line 1, column 9: is not XML: a blank is missing before the attribute 'c'"},
      {"<a><b</a>", "line 1, column 4: is not XML: <b is not ended by '>'"},
      {"<a>1 < 2</a>",
       "line 1, column 6: is not XML: '<' without a name after it (in texts it is written as "
       "&lt;)"},
      {"<a><!-- x </a>", "line 1, column 4: is not XML: a comment begins here that is not ended"},
  };
  for (const Case& one : cases) EXPECT_EQ(xml_fault(one.text), one.fault) << one.text;
}

TEST(TextFault, OfXmlIsNoneInAWholeDocumentAndOneInEachPart) {
  const std::string whole =
      "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ELEMENT a ANY>]>\n<!-- <b> -->\n"
      "<x:a b = 'it \"is\" > 1'\n c=\"\">text &lt; <![CDATA[<b>]]><d/><e ></e >\n</x:a>";
  EXPECT_EQ(xml_fault(whole), "");
  EXPECT_EQ(xml_fault(whole + "\n<!-- end -->\n"), "");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(xml_fault(whole.substr(0, size)), "") << size;
  }
}

}  // namespace
}  // namespace spherule
