// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/parsing/text_scanner.h"

#include "spheretree/error.h"
#include "spheretree/text.h"

#include <algorithm>
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

void TextScanner::expect_line_end() {
  const std::string_view token = token_on_line();
  if (!token.empty()) fail(in_quotes(token) + " where the line should end");
}

double TextScanner::number() {
  return number(token());
}

double TextScanner::number(std::string_view token) const {
  if (token.empty()) fail("a number is missing");
  const std::optional<double> value = finite_number(token);
  if (!value) fail(in_quotes(token) + " is not a finite number");
  return *value;
}

std::int64_t TextScanner::integer() {
  return integer(token());
}

std::int64_t TextScanner::integer(std::string_view token) const {
  if (token.empty()) fail("a whole number is missing");
  const std::optional<std::int64_t> value = whole_number(token);
  if (!value) fail(in_quotes(token) + " is not a whole number");
  return *value;
}

void TextScanner::fail(const std::string& reason) const {
  const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
  const auto lines = std::count(text_.begin(), end, '\n');
  throw Error(subject_, "line " + std::to_string(lines + 1) + ": " + reason);
}

}  // namespace spherule::internal
