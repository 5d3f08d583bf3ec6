// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include "base/parser_fault.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using internal::did_you_mean;
using internal::end_of_other_markup;
using internal::end_of_tag;
using internal::finite_number;
using internal::whole_number;

TEST(Text, FiniteNumber) {
  EXPECT_EQ(finite_number("1"), 1.0);
  EXPECT_EQ(finite_number("+.5"), 0.5);
  EXPECT_EQ(finite_number("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(finite_number("0.1"), 0.1);
  EXPECT_EQ(finite_number("4.9406564584124654e-324"), 0x1p-1074);
  EXPECT_EQ(finite_number("1.7976931348623157e308"), 0x1.fffffffffffffp1023);
  const char* const faults[] = {"",    " 1",   "1 ",       "1,5", "0x1",   "1e",     "--1",
                                "+-1", "+",    "1e+-",     "one", "1e999", "-1e999", "nan",
                                "inf", "-inf", "infinity", "1f",  "1..",   "1\n"};
  for (const std::string text : faults) EXPECT_FALSE(finite_number(text)) << text;
}

// Next to zero the nearest double is zero or the smallest one; half of that is
// 2.4703282292062327208e-324. What is too large is no number, however it is written.
TEST(Text, NumbersThatUnderflow) {
  const std::string zeros(400, '0');
  const std::string many(25, '9');
  for (const std::string& text :
       std::vector<std::string>{"1e-400", "2e-324", "2.4703282292062327e-324", "1E-999", "0e-999",
                                "0e999", "0.0e+999"}) {
    EXPECT_EQ(finite_number(text), 0.0) << text;
  }
  for (const std::string& text : std::vector<std::string>{
           "0." + zeros + "1", "." + zeros + "1e+1", "1e-" + many, "123456.7e-0000999",
           "0." + zeros + "1e70", "1" + zeros + "e-1000"}) {
    EXPECT_EQ(finite_number(text), 0.0) << text;
    EXPECT_EQ(finite_number("+" + text), 0.0) << text;
    const std::optional<double> negative = finite_number("-" + text);
    ASSERT_TRUE(negative) << text;
    EXPECT_TRUE(*negative == 0.0 && std::signbit(*negative)) << text;
  }
  for (const std::string text : {"3e-324", "2.4703282292062328e-324"}) {
    EXPECT_EQ(finite_number(text), 0x1p-1074) << text;
  }
  EXPECT_EQ(finite_number("1" + zeros + "e-400"), 1.0);
  EXPECT_EQ(finite_number("0." + zeros + "1e401"), 1.0);
  for (const std::string& text : std::vector<std::string>{
           "1" + zeros, "1" + zeros + "e-1", "0." + zeros + "1e999", "1e" + many, "1e+" + many,
           ".1e400", "-1" + zeros + ".0", "1e-400x", "1e-"}) {
    EXPECT_FALSE(finite_number(text)) << text;
  }
}

TEST(Text, WholeNumber) {
  EXPECT_EQ(whole_number("0"), 0);
  EXPECT_EQ(whole_number("-12"), -12);
  EXPECT_EQ(whole_number("9223372036854775807"), INT64_MAX);
  for (const std::string text : {"", "9223372036854775808", "1.0", "1e3", "+1", " 1", "1 ", "x"}) {
    EXPECT_FALSE(whole_number(text)) << text;
  }
}

TEST(Text, NumbersAndTheirTexts) {
  for (const double number : {0.0, 0.1, -1.0 / 3.0, 1e300, 5e-324, 1.7976931348623157e308}) {
    EXPECT_EQ(finite_number(internal::number_text(number)), number);
  }
  EXPECT_EQ(internal::number_text(0.1), "0.1");
  EXPECT_EQ(internal::number_text(30.0), "30");
}

TEST(Text, Lines) {
  const std::string text = "a\nb\r\n\rc\n\n\r\r\nd";
  std::vector<std::string_view> lines;
  std::string_view rest = text;
  while (!rest.empty()) lines.push_back(internal::take_line(rest));
  EXPECT_EQ(lines, (std::vector<std::string_view>{"a", "b", "", "c", "", "", "", "d"}));
  EXPECT_EQ(internal::count_line_ends(text), 7U);
  EXPECT_EQ(internal::count_line_ends("a\r"), 1U);
  EXPECT_EQ(internal::count_line_ends(""), 0U);
  EXPECT_EQ(internal::take_line(rest), "");
}

TEST(Text, EscapesOfUrls) {
  for (const auto& [text, decoded] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"a", "a"}, {"%20.stl", " .stl"}, {"a%aF", "a\xaf"}, {"%2541", "%41"}}) {
    EXPECT_EQ(internal::percent_decoded(text).text, decoded) << text;
    EXPECT_FALSE(internal::percent_decoded(text).has_other_percents) << text;
  }
  for (const std::string other : {"%", "a%2", "%2g", "%g2", "%00"}) {
    EXPECT_EQ(internal::percent_decoded(other).text, other);
    EXPECT_TRUE(internal::percent_decoded(other).has_other_percents) << other;
  }
  EXPECT_EQ(internal::percent_decoded("%%20%").text, "% %");
  EXPECT_TRUE(internal::percent_decoded("%%20").has_other_percents);
}

TEST(Text, WordsAndQuotes) {
  using Words = std::vector<std::string_view>;
  EXPECT_EQ(internal::words_of(" one\ttwo\r\n\nthree"), (Words{"one", "two", "three"}));
  EXPECT_EQ(internal::words_of(" \t\n"), Words());
  EXPECT_EQ(internal::in_quotes("a b"), "'a b'");
  EXPECT_EQ(internal::in_quotes(std::string(60, 'x')), "'" + std::string(60, 'x') + "'");
  EXPECT_EQ(internal::in_quotes(std::string(61, 'x')), "'" + std::string(60, 'x') + "...'");
}

struct Thing {
  std::string name;
};

TEST(NearestName, IsOneThatDiffersInFewLetters) {
  const std::vector<std::string> links{"base", "hand", "q1"};
  EXPECT_EQ(did_you_mean("hnad", links), "; did you mean hand?") << "swapped";
  EXPECT_EQ(did_you_mean("bose", links), "; did you mean base?");
  EXPECT_EQ(did_you_mean("q2", links), "; did you mean q1?");
  EXPECT_EQ(did_you_mean("hand_of_the_robot", links), "");
  EXPECT_EQ(did_you_mean("torch", links), "");
  EXPECT_EQ(did_you_mean("base", {}), "");
}

TEST(NearestName, IsOneThatTheWordBegins) {
  const std::vector<Thing> things{{"elbow_joint_of_arm"}, {"wrist"}};
  EXPECT_EQ(did_you_mean("elbow", things, &Thing::name), "; did you mean elbow_joint_of_arm?");
}

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

TEST(XmlMarkup, TagsEndBehindTheirValues) {
  EXPECT_EQ(end_of_tag("<a b='>'/>c", 0), 10U);
  EXPECT_EQ(end_of_tag("x<a b=\"'>\">c", 1), 11U);
  EXPECT_EQ(end_of_tag("<a b='>", 0), 7U) << "does not end";
}

TEST(XmlMarkup, OtherMarkupEndsWhereItsKindDoes) {
  EXPECT_EQ(end_of_other_markup("<!-- <a> --><b/>", 0), 12U);
  EXPECT_EQ(end_of_other_markup("<![CDATA[>]]><b/>", 0), 13U);
  EXPECT_EQ(end_of_other_markup("<?a > ?><b/>", 0), 8U);
  EXPECT_EQ(end_of_other_markup("<!-- <a>", 0), 8U) << "does not end";
  EXPECT_EQ(end_of_other_markup("c<b/>", 1), 1U) << "is a tag";
}

}  // namespace
}  // namespace spherule::test
