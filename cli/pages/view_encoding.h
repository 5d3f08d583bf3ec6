// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace spherule {

// Numbers as the page of `view` carries them: the bytes of 32-bit words, the lowest first, in
// base64.
std::string encode_words(std::span<const float> words);
std::string encode_words(std::span<const std::int32_t> words);

}  // namespace spherule
