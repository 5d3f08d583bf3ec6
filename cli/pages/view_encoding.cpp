// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_encoding.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace spherule {
namespace {

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

// The page reads little-endian words, which is what all machines that run it have.
template <class Word>
std::string encode(std::span<const Word> words) {
  static_assert(sizeof(Word) == 4);
  std::string bytes;
  bytes.reserve(words.size() * 4);
  for (const Word word : words) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &word, 4);
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 255u);
  }
  return base64(bytes);
}

}  // namespace

std::string encode_words(std::span<const float> words) {
  return encode(words);
}

std::string encode_words(std::span<const std::int32_t> words) {
  return encode(words);
}

}  // namespace spherule
