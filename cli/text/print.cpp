// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/print.h"

#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
#include <string_view>

namespace spherule {
namespace {

unsigned byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

bool continues(unsigned byte) {
  return (byte & 0xC0U) == 0x80U;
}

// How many bytes the character of UTF-8 that begins at `at` has; 0 if none does (RFC 3629), and for
// control characters.
std::size_t length_of_character(std::string_view text, std::size_t at) {
  const unsigned first = byte_at(text, at);
  const unsigned second = byte_at(text, at + 1);
  if (first < 0x80) return is_control_character(first) ? 0 : 1;
  if (!continues(second)) return 0;
  // The first byte of U+0080 to U+00BF, whose second is the code point.
  if (first == 0xC2) return is_control_character(second) ? 0 : 2;
  if (first > 0xC2 && first < 0xE0) return 2;
  if (!continues(byte_at(text, at + 2))) return 0;
  if (first >= 0xE0 && first < 0xF0) {
    const bool is_overlong = first == 0xE0 && second < 0xA0;
    const bool is_surrogate = first == 0xED && second >= 0xA0;
    return is_overlong || is_surrogate ? 0 : 3;
  }
  if (first < 0xF0 || first > 0xF4 || !continues(byte_at(text, at + 3))) return 0;
  const bool is_out_of_range =
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90);
  return is_out_of_range ? 0 : 4;
}

std::string escaped(unsigned byte) {
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  if (byte == '\r') return "\\r";
  return "\\x" + hex(byte);
}

// Without its middle where it is long: files may hold names and texts of any length.
std::string shortened(std::string_view message) {
  constexpr std::size_t kKept = 2000;  // at both ends
  if (message.size() <= 2 * kKept) return std::string(message);
  std::size_t head = kKept;
  for (int i = 0; i < 3 && continues(byte_at(message, head)); ++i) --head;
  std::size_t tail = message.size() - kKept;
  for (int i = 0; i < 3 && continues(byte_at(message, tail)); ++i) ++tail;
  return std::string(message.substr(0, head)) + " [...] " + std::string(message.substr(tail));
}

constexpr std::string_view kPlain = "-_./=,:+@%";

std::string shell_word(const std::string& word) {
  bool is_plain = !word.empty();
  std::string quoted = "'";
  for (const char c : word) {
    is_plain = is_plain && (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                            kPlain.find(c) != std::string_view::npos);
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return is_plain ? word : quoted + "'";
}

// A word with control characters, which a terminal must not see, as bash and zsh read it back.
std::string escaped_word(const std::string& word) {
  std::string result = "$'";
  for (const char c : word) {
    if (c == '\\' || c == '\'') result += '\\';
    result += c;
  }
  return one_line(result) + "'";
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    if (const std::size_t length = length_of_character(text, at); length > 0) {
      result += text.substr(at, length);
      at += length;
    } else {
      result += escaped(byte_at(text, at++));
    }
  }
  return result;
}

void tell(std::string_view message) {
  std::cerr << "spherule: " + one_line(shortened(message)) + "\n";
}

void warn(std::string_view message) {
  tell("warning: " + std::string(message));
}

void warn_each(const std::string& subject, std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) warn(subject + ": " + warning);
}

std::string number(double value, int digits) {
  std::ostringstream out;
  out << std::setprecision(digits) << value;
  return out.str();
}

std::string decimal(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  // What is rounded to zero has no sign.
  const std::string text = out.str();
  return text.starts_with('-') && text.find_first_of("123456789") == text.npos ? text.substr(1)
                                                                               : text;
}

std::string percent(double share, int digits) {
  return decimal(100.0 * share, digits) + " %";
}

std::string three_digits(double value, Rounding rounding) {
  if (value == 0.0 || !std::isfinite(value)) return number(value);
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  // A number of three digits is its own bound, however its decimals were rounded.
  constexpr double kSame = 1e-9;
  const double steps = value / step;
  const double whole = std::abs(steps - std::round(steps)) < kSame ? std::round(steps)
                       : rounding == Rounding::kUp                 ? std::ceil(steps)
                                                                   : std::floor(steps);
  return number(whole * step, 3);
}

std::string aligned(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows) {
    for (std::string& cell : row) cell = one_line(cell);
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string describe(const std::vector<NextStep>& steps) {
  std::string text;
  for (const NextStep& step : steps) {
    text += text.empty() ? "next: spherule" : "      spherule";
    for (const std::string& word : step.words) {
      text.append(" ").append(one_line(word) == word ? shell_word(word) : escaped_word(word));
    }
    text.append("    # ").append(step.purpose).append("\n");
  }
  return text;
}

std::string beside(const std::string& path, const std::string& ending) {
  return std::filesystem::path(path).replace_extension(ending).string();
}

std::string here(const std::string& path, const std::string& ending) {
  return beside(std::filesystem::path(path).filename().string(), ending);
}

}  // namespace spherule
