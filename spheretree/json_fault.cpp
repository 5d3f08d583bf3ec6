// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/text.h"
#include "spheretree/text_fault.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

namespace spherule::internal {
namespace {

constexpr int kDeepest = 1000;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_word_part(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

// The bytes of the character of UTF-8 at the beginning of a text, 0 where there is none.
std::size_t character_size(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto follows = [&](std::size_t i, unsigned least = 0x80U, unsigned most = 0xBFU) {
    return byte(i) >= least && byte(i) <= most;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return follows(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {
    const bool is_good = follows(1, first == 0xE0U ? 0xA0U : 0x80U, first == 0xEDU ? 0x9FU : 0xBFU);
    return is_good && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {
    const bool is_good = follows(1, first == 0xF0U ? 0x90U : 0x80U, first == 0xF4U ? 0x8FU : 0xBFU);
    return is_good && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

struct Fault {
  std::size_t at;
  std::string reason;
};

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  // Throws Fault.
  void run() {
    skip_blanks();
    if (is_over()) fail(at_, "nothing is in it");
    value(0);
    skip_blanks();
    if (!is_over()) fail(at_, "something follows after its end");
  }

 private:
  [[noreturn]] static void fail(std::size_t at, std::string reason) {
    throw Fault{at, std::move(reason)};
  }
  bool is_over() const { return at_ >= text_.size(); }
  char next() const { return is_over() ? '\0' : text_[at_]; }

  void skip_blanks() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    if (next() == '/' || next() == '#') fail(at_, "comments are not allowed");
  }

  void value(int depth) {
    if (depth > kDeepest) fail(at_, "is nested too deeply");
    if (is_over()) fail(at_, "it ends where a value is due");
    const char c = next();
    if (c == '{') return list(depth, '}');
    if (c == '[') return list(depth, ']');
    if (c == '"') return string();
    if (c == '-' || is_digit(c)) return number();
    word();
  }

  // An object or an array.
  void list(int depth, char end) {
    const std::size_t start = at_++;
    const bool is_object = end == '}';
    skip_blanks();
    if (next() == end) {
      ++at_;
      return;
    }
    for (;;) {
      if (is_object) key(start);
      value(depth + 1);
      skip_blanks();
      if (next() == end && !is_over()) break;
      if (is_over()) fail_open(start);
      if (next() != ',') fail(at_, std::string("a comma or '") + end + "' is missing");
      const std::size_t comma = at_++;
      skip_blanks();
      if (next() == end) fail(comma + 1, std::string("a comma before '") + end + "'");
      if (is_over()) fail_open(start);
    }
    ++at_;
  }

  [[noreturn]] void fail_open(std::size_t start) const {
    fail(at_, std::string("it ends before the '") + text_[start] + "' of " +
                  place_in(text_, start) + " is closed");
  }

  void key(std::size_t start) {
    if (is_over()) fail_open(start);
    if (next() == '\'') fail(at_, "texts stand in double quotes");
    if (next() != '"') fail(at_, "a key in double quotes is due");
    string();
    skip_blanks();
    if (next() != ':') fail(at_, "a colon after the key is missing");
    ++at_;
    skip_blanks();
  }

  void string() {
    const std::size_t start = at_++;
    for (;;) {
      if (is_over()) fail(start, "a text begins here that is not ended by a double quote");
      const char c = next();
      if (c == '"') break;
      if (c == '\n') fail(start, "a text begins here that is not ended on its line");
      if (static_cast<unsigned char>(c) < 0x20U) {
        fail(at_, c == '\t' ? "a tab in a text is written as \\t"
                            : "a control character in a text has to be escaped");
      }
      const std::size_t size = character_size(text_.substr(at_));
      if (size == 0) fail(at_, "a text is not valid UTF-8");
      c == '\\' ? escape() : static_cast<void>(at_ += size);
    }
    ++at_;
  }

  void escape() {
    const std::size_t start = at_++;
    constexpr std::string_view kPlain = "\"\\/bfnrt";
    if (!is_over() && kPlain.find(next()) != std::string_view::npos) {
      ++at_;
      return;
    }
    if (next() != 'u') fail(start, "a backslash in a text is written as \\\\");
    const std::uint32_t unit = code_unit(start);
    const bool is_high = unit >= 0xD800U && unit <= 0xDBFFU;
    const bool is_low = unit >= 0xDC00U && unit <= 0xDFFFU;
    if (!is_high && !is_low) return;
    if (is_high && text_.substr(at_).starts_with("\\u")) {
      ++at_;
      const std::uint32_t low = code_unit(start);
      if (low >= 0xDC00U && low <= 0xDFFFU) return;
    }
    fail(start, "\\u with half of a character");
  }

  std::uint32_t code_unit(std::size_t start) {
    const std::string_view digits = text_.substr(std::min(at_ + 1, text_.size()), 4);
    std::uint32_t unit = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), unit, 16);
    if (digits.size() < 4 || read.ptr != digits.data() + digits.size()) {
      fail(start, "\\u without four hexadecimal digits");
    }
    at_ += 5;
    return unit;
  }

  void digits(std::size_t start) {
    if (!is_digit(next())) fail(start, "a number is not complete");
    while (is_digit(next())) ++at_;
  }

  void number() {
    const std::size_t start = at_;
    if (next() == '-') ++at_;
    const bool is_zero = next() == '0';
    if (next() == 'I' || next() == 'i') fail(start, "infinity is not a number of JSON");
    digits(start);
    const std::size_t whole = at_ - start - (text_[start] == '-' ? 1 : 0);
    if (is_zero && whole > 1) fail(start, "a number begins with a needless 0");
    if (next() == '.') {
      ++at_;
      digits(start);
    }
    if (next() == 'e' || next() == 'E') {
      ++at_;
      if (next() == '+' || next() == '-') ++at_;
      digits(start);
    }
    double read = 0.0;
    const auto result = std::from_chars(text_.data() + start, text_.data() + at_, read);
    const bool is_large = result.ec == std::errc::result_out_of_range && exponent(start) > 0;
    if (is_large)
      fail(start, "the number " + in_quotes(text_.substr(start, at_ - start)) + " is too large");
  }

  // Of a number that is out of the range of a double: above zero if it is too large.
  int exponent(std::size_t start) const {
    const std::string_view digits = text_.substr(start, at_ - start);
    const std::size_t e = digits.find_first_of("eE");
    if (e == std::string_view::npos) return digits.find('.') > 300 ? 1 : -1;
    return digits.substr(e + 1).starts_with('-') ? -1 : 1;
  }

  void word() {
    std::size_t end = at_;
    while (end < text_.size() && is_word_part(text_[end])) ++end;
    const std::string_view found = text_.substr(at_, end - at_);
    if (found == "true" || found == "false" || found == "null") {
      at_ = end;
      return;
    }
    if (next() == '\'') fail(at_, "texts stand in double quotes");
    if (next() == ',' || next() == ']' || next() == '}' || next() == ':') {
      fail(at_, std::string("'") + next() + "' where a value is due");
    }
    if (found.empty()) fail(at_, "no value of JSON begins so");
    fail(at_, in_quotes(found) + " is not a value of JSON");
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string json_fault(std::string_view text) {
  try {
    Scanner(text).run();
  } catch (const Fault& fault) {
    return place_in(text, fault.at) + ": is not JSON: " + fault.reason;
  }
  return {};
}

}  // namespace spherule::internal
