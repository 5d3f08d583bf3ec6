// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/png_image.h"

#include <cstdlib>
#include <stdexcept>
#include <zlib.h>

namespace spherule {
namespace {

constexpr std::size_t kSignature = 8;

std::size_t big_endian(const std::string& bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  }
  return value;
}

std::uint8_t paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left);
  const int to_up = std::abs(guess - up);
  const int to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(to_up <= to_corner ? up : corner);
}

// What a filter of the format adds to a byte.
std::uint8_t prediction(int filter, std::uint8_t left, std::uint8_t up, std::uint8_t corner) {
  switch (filter) {
    case 0:
      return 0;
    case 1:
      return left;
    case 2:
      return up;
    case 3:
      return static_cast<std::uint8_t>((left + up) / 2);
    case 4:
      return paeth(left, up, corner);
    default:
      throw std::runtime_error("png: unknown filter");
  }
}

}  // namespace

Picture decode_png(const std::string& bytes) {
  Picture picture;
  std::string packed;
  std::size_t channels = 0;
  for (std::size_t at = kSignature; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian(bytes, at);
    const std::string type = bytes.substr(at + 4, 4);
    const std::size_t data = at + 8;
    if (type == "IHDR") {
      picture.width = big_endian(bytes, data);
      picture.height = big_endian(bytes, data + 4);
      const char colour = bytes.at(data + 9);
      if (bytes.at(data + 8) != 8 || (colour != 2 && colour != 6) || bytes.at(data + 12) != 0) {
        throw std::runtime_error("png: not 8 bits a channel, or interlaced");
      }
      channels = colour == 2 ? 3 : 4;
    } else if (type == "IDAT") {
      packed += bytes.substr(data, length);
    }
    at = data + length + 4;
  }
  const std::size_t stride = picture.width * channels;
  std::vector<std::uint8_t> rows((stride + 1) * picture.height);
  uLongf size = rows.size();
  if (rows.empty() ||
      uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 packed.size()) != Z_OK ||
      size != rows.size()) {
    throw std::runtime_error("png: cannot be unpacked");
  }
  std::vector<std::uint8_t> above(stride, 0);
  for (std::size_t y = 0; y < picture.height; ++y) {
    std::uint8_t* row = rows.data() + y * (stride + 1);
    const int filter = *row++;
    for (std::size_t i = 0; i < stride; ++i) {
      const bool first = i < channels;
      row[i] =
          static_cast<std::uint8_t>(row[i] + prediction(filter, first ? 0 : row[i - channels],
                                                        above[i], first ? 0 : above[i - channels]));
    }
    above.assign(row, row + stride);
    for (std::size_t x = 0; x < picture.width; ++x) {
      const std::uint8_t* pixel = row + x * channels;
      picture.pixels.push_back({pixel[0], pixel[1], pixel[2]});
    }
  }
  return picture;
}

}  // namespace spherule
