// SPDX-License-Identifier: BSD-3-Clause
#include "io/uri.h"

#include "base/text.h"

#include <array>
#include <cstdint>
#include <system_error>

namespace spherule::internal {
namespace {

int digit_of_base64(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

std::optional<std::string> from_base64(std::string_view text) {
  std::size_t padding = 0;
  while (padding < 2 && text.ends_with('=')) {
    text.remove_suffix(1);
    ++padding;
  }
  if (text.size() % 4 == 1 || (padding > 0 && (text.size() + padding) % 4 != 0)) {
    return std::nullopt;
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = digit_of_base64(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xFF));
    }
  }
  return bytes;
}

}  // namespace

std::optional<std::string> bytes_of_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!uri.starts_with("data:") || comma == std::string_view::npos) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(";base64")) return std::nullopt;
  return from_base64(uri.substr(comma + 1));
}

std::optional<std::filesystem::path> file_below(const std::filesystem::path& folder,
                                                std::string_view reference) {
  // A colon before any slash ends a scheme.
  const std::size_t colon = reference.find(':');
  if (colon != std::string_view::npos && colon < reference.find('/')) return std::nullopt;
  const PercentDecoded name = percent_decoded(reference);
  if (name.has_other_percents || name.text.empty() || name.text.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  const std::filesystem::path relative(name.text);
  if (relative.is_absolute()) return std::nullopt;
  std::error_code error;
  const std::filesystem::path root =
      std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error) return std::nullopt;
  const std::filesystem::path file = std::filesystem::weakly_canonical(root / relative, error);
  if (error || !std::filesystem::is_regular_file(file, error) || error) return std::nullopt;
  const std::filesystem::path inside = file.lexically_relative(root);
  if (inside.empty() || *inside.begin() == "..") return std::nullopt;
  return file;
}

}  // namespace spherule::internal
