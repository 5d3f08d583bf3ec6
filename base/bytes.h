// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Numbers in binary files: integers and floating-point numbers as their bytes.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>

namespace spherule::internal {

// The number whose bytes stand there, which are those of a file in this order.
template <class Number>
Number number_at(const char* bytes, std::endian order = std::endian::little) {
  std::array<char, sizeof(Number)> image;
  std::memcpy(image.data(), bytes, image.size());
  if (std::endian::native != order) std::reverse(image.begin(), image.end());
  return std::bit_cast<Number>(image);
}

// Appends the bytes of a number, the least significant one first.
template <class Number>
void append_number(std::string& bytes, Number number) {
  auto image = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (std::endian::native != std::endian::little) std::reverse(image.begin(), image.end());
  bytes.append(image.data(), image.size());
}

}  // namespace spherule::internal
