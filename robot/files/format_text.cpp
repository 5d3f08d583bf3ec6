// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/format_text.h"

#include "base/error.h"
#include "base/text.h"
#include "io/sphere_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace spherule::internal {
namespace {

// The code point that starts at `text` (which is not empty) and its length; a length of 0 where the
// bytes are not UTF-8.
std::pair<std::uint32_t, std::size_t> code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return {0, 0};
  std::uint32_t point = first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {0, 0};
    point = (point << 6) | (byte(i) & 0x3fu);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = point >= 0xd800 && point <= 0xdfff;
  if (point < kSmallest[length] || point > 0x10ffff || surrogate) return {0, 0};
  return {point, length};
}

// Not allowed as they are in XML or YAML.
bool is_control(std::uint32_t point) {
  return point < 0x20 || (point >= 0x7f && point < 0xa0) || (point & 0xfffe) == 0xfffe;
}

}  // namespace

std::string decimal(double value) {
  std::array<char, 512> buffer;  // the smallest double takes 327 characters, the largest 310
  const auto [end, fault] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed);
  std::string text(buffer.data(), end);
  if (text.find('.') == std::string::npos) text += ".0";
  return text;
}

std::string decimals(const Eigen::Vector3d& point, std::string_view separator) {
  return decimal(point.x()) + std::string(separator) + decimal(point.y()) + std::string(separator) +
         decimal(point.z());
}

std::string fault_of_name(std::string_view name) {
  if (name.empty()) return "is empty";
  while (!name.empty()) {
    const auto [point, length] = code_point(name);
    if (length == 0) return "is not UTF-8";
    if (is_control(point)) return "holds a control character";
    name.remove_prefix(length);
  }
  return {};
}

bool is_plain_yaml(std::string_view text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto inner = [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '/';
  };
  if (text.empty() || !(letter(text[0]) || (text[0] == '/' && text.size() > 1))) return false;
  if (!std::all_of(text.begin(), text.end(), inner)) return false;
  constexpr std::string_view kWords[] = {"true", "false", "yes",  "no",  "on", "off",
                                         "y",    "n",     "null", "inf", "nan"};
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return std::find(std::begin(kWords), std::end(kWords), lower) == std::end(kWords);
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = code_point(text).second;
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::string_view kMarks = ",;";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Whether a comma may be the decimal one of a number, as in "0,5; 1,5" and "0,5 1,5": another mark
// or a blank separates, too.
bool has_doubtful_commas(std::string_view line) {
  if (line.find(',') == line.npos) return false;
  if (line.find(';') != line.npos) return true;
  while (!line.empty()) {
    const std::size_t mark = std::min(line.find(','), line.size());
    if (trimmed(line.substr(0, mark)).find_first_of(kBlanks) != line.npos) return true;
    line.remove_prefix(std::min(mark + 1, line.size()));
  }
  return false;
}

void split(std::string_view line, std::vector<std::string_view>& words) {
  for (;;) {
    const std::size_t mark = std::min(line.find_first_of(kMarks), line.size());
    std::string_view cell = trimmed(line.substr(0, mark));
    if (cell.empty()) words.push_back(cell);
    while (!cell.empty()) {
      const std::size_t blank = std::min(cell.find_first_of(kBlanks), cell.size());
      words.push_back(cell.substr(0, blank));
      cell = trimmed(cell.substr(blank));
    }
    if (mark == line.size()) return;
    line.remove_prefix(mark + 1);
  }
}

}  // namespace

bool TextLines::next() {
  while (!rest_.empty()) {
    ++number_;
    std::string_view line = take_line(rest_);
    line = trimmed(line.substr(0, std::min(line.find('#'), line.size())));
    if (line.empty()) continue;
    words_.clear();
    split(line, words_);
    if (words_.size() > columns_) {
      const std::string_view last = words_[columns_ - 1];
      line = line.substr(0, static_cast<std::size_t>(last.data() - line.data()) + last.size());
    }
    if (has_doubtful_commas(line)) {
      refuse(
          "has commas beside other separators; numbers are separated by commas, by semicolons or "
          "by blanks, and their decimals are after a point");
    }
    return true;
  }
  return false;
}

void TextLines::refuse(const std::string& reason) const {
  throw Error(file_, "line " + std::to_string(number_) + ": " + reason);
}

std::vector<Sphere> load_spheres_in_metres(const std::filesystem::path& path) {
  SphereFile file = load_spheres(path);
  const auto units = file.options.find("units");
  if (units != file.options.end()) {
    const auto* name = std::get_if<std::string>(&units->second);
    if (name == nullptr || *name != "m") {
      throw Error(path.string(), "has its lengths in " +
                                     (name == nullptr ? "an unknown unit" : in_quotes(*name)) +
                                     ", as its options say; robots and scenes are in metres (see "
                                     "--units and --scale of fit)");
    }
  }
  return std::move(file.spheres);
}

}  // namespace spherule::internal
