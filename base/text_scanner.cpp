// SPDX-License-Identifier: BSD-3-Clause
#include "base/text_scanner.h"

#include "base/error.h"
#include "base/text.h"

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

TextScanner::TextScanner(std::string_view text, std::string subject, TextSyntax syntax)
    : text_(text), subject_(std::move(subject)), syntax_(syntax) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
}

bool TextScanner::is_comment() const {
  return syntax_.comment != '\0' && text_[at_] == syntax_.comment;
}

std::size_t TextScanner::continuation() const {
  if (!syntax_.has_continued_lines || text_[at_] != '\\') return 0;
  const std::string_view after = text_.substr(at_ + 1, 2);
  if (after.empty() || !is_line_end(after[0])) return 0;
  return after == "\r\n" ? 3 : 2;
}

void TextScanner::skip_to_line_end() {
  while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
}

void TextScanner::skip_space(bool across_lines) {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (is_comment()) {
      skip_to_line_end();
    } else if (const std::size_t size = continuation(); size > 0) {
      at_ += size;
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
  while (at_ < text_.size() && !is_space(text_[at_]) && !is_comment()) {
    if (const std::size_t size = continuation(); size > 0) {
      const std::size_t next = at_ + size;
      if (next < text_.size() && !is_space(text_[next])) fail("a word goes on in the next line");
      break;
    }
    ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::token_on_line() {
  skip_space(false);
  return at_ < text_.size() && !is_line_end(text_[at_]) ? token() : std::string_view();
}

void TextScanner::skip_line() {
  while (at_ < text_.size() && !is_line_end(text_[at_]) && !is_comment()) {
    at_ += std::max<std::size_t>(continuation(), 1);
  }
  skip_to_line_end();
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
  const std::size_t lines = count_line_ends(text_.substr(0, at_));
  throw Error(subject_, "line " + std::to_string(lines + 1) + ": " + reason);
}

}  // namespace spherule::internal
