// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace spherule {

// A picture of 8-bit red, green and blue.
struct Picture {
  using Pixel = std::array<std::uint8_t, 3>;
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Pixel> pixels;  // row by row from the top

  Pixel at(std::size_t x, std::size_t y) const { return pixels[y * width + x]; }
};

// Of a PNG file's bytes with 8 bits a channel, RGB or RGBA (which is dropped), not interlaced: what
// browsers write. Throws std::runtime_error for others.
Picture decode_png(const std::string& bytes);

}  // namespace spherule
