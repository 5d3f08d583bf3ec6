// SPDX-License-Identifier: BSD-3-Clause
#include "base/crc64.h"

#include <array>
#include <cstddef>

namespace spherule {
namespace {

constexpr std::uint64_t kReflectedPolynomial = 0xC96C5795D7870F42U;

// Table of the remainders of all bytes.
constexpr std::array<std::uint64_t, 256> remainders() {
  std::array<std::uint64_t, 256> table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1U) ^ ((remainder & 1U) != 0U ? kReflectedPolynomial : 0U);
    }
    table[byte] = remainder;
  }
  return table;
}

constexpr std::array<std::uint64_t, 256> kRemainders = remainders();

}  // namespace

std::uint64_t crc64(std::string_view bytes) {
  std::uint64_t remainder = ~std::uint64_t{0};
  for (const char c : bytes) {
    remainder =
        (remainder >> 8U) ^ kRemainders[(remainder ^ static_cast<unsigned char>(c)) & 0xFFU];
  }
  return ~remainder;
}

}  // namespace spherule
