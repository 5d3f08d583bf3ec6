// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

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

}  // namespace
}  // namespace spherule::test
