// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/message.h"

#include "cli/text/control_character.h"

#include <cstddef>
#include <iostream>

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

}  // namespace spherule
