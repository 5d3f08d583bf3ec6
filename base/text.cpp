// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <vector>

namespace spherule::internal {
namespace {

template <class Number>
std::errc parse(std::string_view text, Number& value) {
  const char* const end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, value);
  return stop == end ? fault : std::errc::bad_message;
}

// Of a decimal number that no double is near to: whether it is too small, not too large. It is
// below 1 if its exponent does not make up for the place of its first digit.
bool is_too_small(std::string_view text) {
  const std::size_t end = std::min(text.find_first_of("eE"), text.size());
  const std::string_view digits = text.substr(0, end);
  std::string_view exponent = text.substr(std::min(end + 1, text.size()));
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  const auto point = static_cast<std::int64_t>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<std::int64_t>(digits.find_first_of("123456789"));
  const std::int64_t needed = first < point ? first - point + 1 : first - point;
  if (exponent.empty()) return 0 < needed;
  const std::optional<std::int64_t> value = whole_number(exponent);
  return value ? *value < needed : exponent.starts_with('-');
}

int digit_of_hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// The character that the first three of a text stand for, where they are an escape.
std::optional<char> percent_escape(std::string_view text) {
  if (text.size() < 3 || text[0] != '%') return std::nullopt;
  const int high = digit_of_hex(text[1]);
  const int low = digit_of_hex(text[2]);
  if (high < 0 || low < 0 || (high == 0 && low == 0)) return std::nullopt;
  return static_cast<char>(16 * high + low);
}

}  // namespace

std::optional<double> finite_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const std::errc fault = parse(text, value);
  if (fault == std::errc::result_out_of_range && is_too_small(text)) {
    return text.starts_with('-') ? -0.0 : 0.0;
  }
  return fault == std::errc() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

bool has_form_of_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const std::errc fault = parse(text, value);
  return fault == std::errc() || fault == std::errc::result_out_of_range;
}

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  return parse(text, value) == std::errc() ? std::optional(value) : std::nullopt;
}

std::string number_text(double number) {
  std::array<char, 32> text{};  // the longest takes 24
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string_view byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.substr(0, text.starts_with(kMark) ? kMark.size() : 0);
}

std::vector<std::string_view> words_of(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string_view> words;
  for (std::size_t at = text.find_first_not_of(kSpace); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(kSpace, end);
  }
  return words;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  const bool has_both = text.substr(end).starts_with("\r\n");
  text.remove_prefix(std::min(end + (has_both ? 2 : 1), text.size()));
  return line;
}

std::size_t count_line_ends(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_first_of_two = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
    if (text[i] == '\n' || (text[i] == '\r' && !is_first_of_two)) ++count;
  }
  return count;
}

PercentDecoded percent_decoded(std::string_view text) {
  PercentDecoded result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::optional<char> character = percent_escape(text.substr(i));
    if (!character && text[i] == '%') result.has_other_percents = true;
    result.text += character.value_or(text[i]);
    if (character) i += 2;
  }
  return result;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string result("'");
  result.append(text.substr(0, kLongest));
  return result.append(text.size() > kLongest ? "...'" : "'");
}

namespace {

// How many letters have to be put in, taken out, replaced or swapped with their neighbours (optimal
// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      edits[i][j] = std::min({replaced, edits[i - 1][j] + 1, edits[i][j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[a.size()][b.size()];
}

std::string nearest_name(std::string_view word, std::span<const std::string> known) {
  std::string best;
  const bool is_short_name = word.size() == 2 && word.front() != '-';
  std::size_t least = (is_short_name ? 1 : word.size() / 3) + 1;
  for (const std::string& name : known) {
    if (name.size() >= word.size() + least) continue;  // at least as many letters differ
    const std::size_t distance = edit_distance(word, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  if (!best.empty() || word.size() < 2) return best;
  const auto longer = std::find_if(known.begin(), known.end(), [&](const std::string& name) {
    return word != "--" && name.starts_with(word);
  });
  return longer == known.end() ? std::string() : *longer;
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  // Of long words no one means another, and each pair of letters costs time.
  constexpr std::size_t kLongest = 100;
  if (word.size() > kLongest) return {};
  const std::string name = nearest_name(word, known);
  return name.empty() ? "" : "; did you mean " + name + "?";
}

}  // namespace spherule::internal
