// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule {

// Whether a code point is a control character, which a terminal obeys: C0, DEL and C1 (U+0080 to
// U+009F, two bytes in UTF-8).
constexpr bool is_control_character(unsigned code_point) {
  return code_point < 0x20U || (code_point >= 0x7FU && code_point < 0xA0U);
}

// Two hexadecimal digits.
inline std::string hex(unsigned byte) {
  constexpr const char* kDigits = "0123456789abcdef";
  return {kDigits[byte >> 4U & 15U], kDigits[byte & 15U]};
}

}  // namespace spherule
