// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace spherule::internal {

struct TextSyntax {
  char comment = '\0';  // starts a comment up to the end of the line ('\0': there are none)
  // A backslash at the end of a line continues it, but not a comment. One that cuts a word in two
  // is an error where the word is read.
  bool has_continued_lines = false;
};

// Splits the text of a mesh file into tokens at white space. Every fault is an Error that names the
// file and the line. Does not depend on the locale.
class TextScanner {
 public:
  TextScanner(std::string_view text, std::string subject, TextSyntax syntax = {});

  // The next token, across lines; empty at the end of the text.
  std::string_view token();
  // The next token of this line; empty at its end.
  std::string_view token_on_line();
  void skip_line();
  // Fails if there is anything left on this line.
  void expect_line_end();

  // The next token as a number; the nearest double, so that the error is at most 2^-53 of it, or
  // 2^-1075. Not a number, not finite and the end of the text are errors.
  double number();
  double number(std::string_view token) const;
  std::int64_t integer();
  std::int64_t integer(std::string_view token) const;

  [[noreturn]] void fail(const std::string& reason) const;
  const std::string& subject() const { return subject_; }
  std::size_t position() const { return at_; }
  void seek(std::size_t position) { at_ = position; }

 private:
  void skip_space(bool across_lines);
  void skip_to_line_end();
  bool is_comment() const;
  // Bytes of the backslash and the end of the line that stand here; 0 if they do not.
  std::size_t continuation() const;

  std::string_view text_;
  std::string subject_;
  std::size_t at_ = 0;
  TextSyntax syntax_;
};

}  // namespace spherule::internal
