// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/io/internal/text_scanner.h"

#include "spheretree/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace spherule::internal {
namespace {

bool is_line_end(char c) {
  return c == '\n' || c == '\r';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_line_end(c);
}

}  // namespace

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result.append(text.substr(0, 40));
  result.append("'");
  return result;
}

TextScanner::TextScanner(std::string_view text, std::string subject, char comment)
    : text_(text), subject_(std::move(subject)), comment_(comment) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
}

void TextScanner::skip_space(bool across_lines) {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (comment_ != '\0' && c == comment_) {
      while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
    } else if (c == '\\' && at_ + 1 < text_.size() && is_line_end(text_[at_ + 1])) {
      const bool two = text_[at_ + 1] == '\r' && at_ + 2 < text_.size() && text_[at_ + 2] == '\n';
      at_ += two ? 3 : 2;
    } else if (is_space(c) && (across_lines || !is_line_end(c))) {
      ++at_;
    } else {
      return;
    }
  }
}

std::string_view TextScanner::token() {
  skip_space(true);
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_space(text_[at_]) &&
         (comment_ == '\0' || text_[at_] != comment_)) {
    ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::token_on_line() {
  skip_space(false);
  return at_ < text_.size() && !is_line_end(text_[at_]) ? token() : std::string_view();
}

void TextScanner::skip_line() {
  while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
}

double TextScanner::number() {
  return number(token());
}

double TextScanner::number(std::string_view token) const {
  if (token.empty()) fail("the file ends where a number should stand");
  std::string_view digits = token;
  if (digits.front() == '+') digits.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
    fail(in_quotes(token) + " is not a number");
  }
  // Out of range is reported for numbers that are too large and for numbers next to zero.
  if (error == std::errc::result_out_of_range) {
    const std::size_t exponent = digits.find_first_of("eE");
    if (exponent != std::string_view::npos && digits.substr(exponent + 1).starts_with('-')) {
      return 0.0;
    }
    fail(in_quotes(token) + " is too large");
  }
  if (!std::isfinite(value)) fail(in_quotes(token) + " is not a finite number");
  return value;
}

std::int64_t TextScanner::integer() {
  return integer(token());
}

std::int64_t TextScanner::integer(std::string_view token) const {
  if (token.empty()) fail("the file ends where a whole number should stand");
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || error != std::errc()) {
    fail(in_quotes(token) + " is not a whole number");
  }
  return value;
}

void TextScanner::fail(const std::string& reason) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
  const auto lines = std::count(text_.begin(), end, '\n');
  throw Error(subject_, "line " + std::to_string(lines + 1) + ": " + reason);
}

}  // namespace spherule::internal
