// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace spherule::internal {

// Splits the text of a mesh file into tokens at white space. Every fault is an Error that names the
// file and the line. Does not depend on the locale.
class TextScanner {
 public:
  // `comment` starts a comment up to the end of the line ('\0': there are none).
  TextScanner(std::string_view text, std::string subject, char comment = '\0');

  // The next token, across lines; empty at the end of the text.
  std::string_view token();
  // The next token of this line; empty at its end. A lone backslash continues the line.
  std::string_view token_on_line();
  void skip_line();
  // Fails if there is anything left on this line.
  void expect_line_end();

  // The next token as a number; the nearest double, so that the error is at most 2^-53 of it. Not
  // a number, not finite and the end of the text are errors.
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

  std::string_view text_;
  std::string subject_;
  std::size_t at_ = 0;
  char comment_;
};

}  // namespace spherule::internal
