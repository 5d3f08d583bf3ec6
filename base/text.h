// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What all readers of text share: numbers, words, lines, and quotes for messages. Does not depend
// on the locale.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// The value of a text that is one decimal number and nothing else, with or without an exponent; the
// nearest double, which is zero for what is at most 2^-1075. Nothing for other texts, infinities
// and what is too large for a double.
std::optional<double> finite_number(std::string_view text);

// Whether a text looks like one decimal number, though finite_number() may have no value for it:
// also infinities, "nan", what is too large for a double, and "+-1".
bool has_form_of_number(std::string_view text);

// The value of a text that is one whole number and nothing else: digits only, with a minus sign
// where it is negative. Nothing for other texts and what std::int64_t cannot hold.
std::optional<std::int64_t> whole_number(std::string_view text);

// The shortest decimal text from which finite_number() gets a finite number back, bit for bit.
std::string number_text(double number);

// The byte order mark that a text in UTF-8 begins with; empty where there is none.
std::string_view byte_order_mark(std::string_view text);

// The words of a text, apart by blanks, tabs and ends of lines.
std::vector<std::string_view> words_of(std::string_view text);

// Takes the first line off a text and returns it without its end: a line feed, a carriage return,
// or both in this order.
std::string_view take_line(std::string_view& text);

// How many such ends of lines a text has.
std::size_t count_line_ends(std::string_view text);

// A text of a URL with the characters that it writes as %20 and the like. What is no such escape,
// and %00, which would end a string, stays.
struct PercentDecoded {
  std::string text;
  bool has_other_percents = false;  // some that begin no escape
};
PercentDecoded percent_decoded(std::string_view text);

// A text in quotes for a message; of a long one the first 60 characters.
std::string in_quotes(std::string_view text);

// Which name may have been meant, for messages about one that is not known.

// "; did you mean NAME?" with the one of `known` that differs least from `word`, if only a few
// letters do: one in three, one of two in a name of two, neighbours that are swapped counting as
// one; or with one that `word` begins. Otherwise nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

// did_you_mean() with the names of things as what is known: did_you_mean(name, links, &Link::name).
template <class Things, class Name>
std::string did_you_mean(std::string_view word, const Things& things, Name name_of) {
  std::vector<std::string> known;
  for (const auto& thing : things) known.push_back(std::invoke(name_of, thing));
  return did_you_mean(word, known);
}

}  // namespace spherule::internal
