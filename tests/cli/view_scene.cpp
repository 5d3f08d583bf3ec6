// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/view_scene.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

namespace spherule {

nlohmann::json scene_of(const std::string& page) {
  const std::string start = "<script id=\"scene\" type=\"application/json\">";
  const std::size_t begin = page.find(start);
  const std::size_t end = page.find("</script>", begin);
  EXPECT_NE(begin, std::string::npos);
  EXPECT_NE(end, std::string::npos);
  return nlohmann::json::parse(page.substr(begin + start.size(), end - begin - start.size()));
}

std::vector<float> floats_of(const std::string& text) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255u);
  }
  std::vector<float> numbers(bytes.size() / 4);
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * 4);
  return numbers;
}

}  // namespace spherule
