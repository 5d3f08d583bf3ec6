// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/ply_points.h"

#include "robot/files/internal/format_text.h"
#include "robot/files/internal/text_lines.h"
#include "spheretree/error.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

enum class Number { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Property {
  std::string name;
  Number type = Number::kFloat;
  std::optional<Number> count{};  // of a list: the type of its length
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties{};
};

std::optional<Number> number_named(std::string_view name) {
  static constexpr std::pair<std::string_view, Number> kNames[] = {
      {"char", Number::kInt8},     {"int8", Number::kInt8},     {"uchar", Number::kUint8},
      {"uint8", Number::kUint8},   {"short", Number::kInt16},   {"int16", Number::kInt16},
      {"ushort", Number::kUint16}, {"uint16", Number::kUint16}, {"int", Number::kInt32},
      {"int32", Number::kInt32},   {"uint", Number::kUint32},   {"uint32", Number::kUint32},
      {"float", Number::kFloat},   {"float32", Number::kFloat}, {"double", Number::kDouble},
      {"float64", Number::kDouble}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

std::size_t size_of(Number type) {
  static constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

class PlyReader {
 public:
  PlyReader(std::string_view content, const std::string& file) : rest_(content), file_(file) {}

  PlyPoints read() {
    read_header();
    PlyPoints result;
    result.is_text = encoding_ == Encoding::kText;
    for (const Element& element : elements_) {
      if (element.properties.empty()) refuse("its element " + element.name + " has no properties");
      const bool is_vertex = element.name == "vertex";
      std::array<std::size_t, 3> axes{};
      if (is_vertex) axes = find_axes(element);
      for (std::size_t i = 0; i < element.count; ++i) {
        place_ = element.name + " " + std::to_string(i);
        read_item(element);
        if (is_vertex) {
          result.points.emplace_back(values_[axes[0]], values_[axes[1]], values_[axes[2]]);
        }
      }
      if (is_vertex) return result;
    }
    refuse("it has no vertices");
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw Error(file_, reason); }

  std::string_view take_line() {
    if (rest_.empty()) refuse("it is cut short");
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
  static std::vector<std::string_view> words_of(std::string_view line) {
    TextLines lines(line);
    return lines.next() ? lines.words() : std::vector<std::string_view>();
  }

  void read_header() {
    if (take_line() != "ply") refuse("it does not begin with \"ply\"");
    bool has_format = false;
    for (;;) {
      const std::vector<std::string_view> words = words_of(take_line());
      const std::string_view key = words.empty() ? "" : words[0];
      if (key == "end_header") break;
      if (key == "comment" || key == "obj_info" || key.empty()) continue;
      if (key == "format") {
        take_format(words);
        has_format = true;
      } else if (key == "element") {
        take_element(words);
      } else if (key == "property") {
        take_property(words);
      } else {
        refuse_header();
      }
    }
    if (!has_format) refuse("its header has no format");
  }

  [[noreturn]] void refuse_header() const {
    refuse("line " + std::to_string(line_) + ": is no line of a PLY header");
  }

  void take_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3 || words[2] != "1.0") refuse_header();
    if (words[1] == "ascii") {
      encoding_ = Encoding::kText;
    } else if (words[1] == "binary_little_endian") {
      encoding_ = Encoding::kLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      encoding_ = Encoding::kBigEndian;
    } else {
      refuse_header();
    }
  }

  void take_element(const std::vector<std::string_view>& words) {
    const std::optional<double> count = words.size() == 3 ? number_of(words[2]) : std::nullopt;
    // As many as fit in memory are at least a byte each.
    if (!count || *count < 0.0 || *count > 0x1p40) refuse_header();
    elements_.push_back({std::string(words[1]), static_cast<std::size_t>(*count)});
  }

  void take_property(const std::vector<std::string_view>& words) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (elements_.empty() || (words.size() != 3 && !is_list)) refuse_header();
    const std::optional<Number> type = number_named(words[words.size() - 2]);
    Property property{std::string(words.back()), type.value_or(Number::kFloat)};
    if (is_list) property.count = number_named(words[2]);
    if (!type || (is_list && !property.count)) refuse_header();
    elements_.back().properties.push_back(property);
  }

  std::array<std::size_t, 3> find_axes(const Element& vertex) const {
    std::array<std::size_t, 3> axes{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name(1, static_cast<char>('x' + static_cast<int>(k)));
      const auto found = std::find_if(
          vertex.properties.begin(), vertex.properties.end(),
          [&](const Property& property) { return property.name == name && !property.count; });
      if (found == vertex.properties.end()) refuse("its vertices have no " + name);
      axes[k] = static_cast<std::size_t>(found - vertex.properties.begin());
    }
    return axes;
  }

  // One vertex, or whatever it is; of a list its length.
  void read_item(const Element& element) {
    values_.clear();
    words_.clear();
    if (encoding_ == Encoding::kText) words_ = words_of(take_line());
    word_ = 0;
    for (const Property& property : element.properties) {
      values_.push_back(take_number(property.count.value_or(property.type)));
      if (!property.count) continue;
      for (double left = values_.back(); left >= 1.0; left -= 1.0) take_number(property.type);
    }
  }

  double take_number(Number type) {
    if (encoding_ != Encoding::kText) return take_binary(type);
    if (word_ >= words_.size()) refuse(place_ + " has too few numbers");
    const std::optional<double> number = number_of(words_[word_]);
    if (!number) {
      refuse("line " + std::to_string(line_) + ": " + quoted(words_[word_]) +
             " is not a finite number");
    }
    ++word_;
    return *number;
  }

  double take_binary(Number type) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) refuse("it is cut short in " + place_);
    std::array<unsigned char, 8> bytes{};
    std::memcpy(bytes.data(), rest_.data(), size);
    rest_.remove_prefix(size);
    const bool is_little = std::endian::native == std::endian::little;
    if (is_little != (encoding_ == Encoding::kLittleEndian)) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    const auto as = [&](auto value) {
      std::memcpy(&value, bytes.data(), sizeof value);
      return static_cast<double>(value);
    };
    switch (type) {
      case Number::kInt8:
        return as(std::int8_t{});
      case Number::kUint8:
        return as(std::uint8_t{});
      case Number::kInt16:
        return as(std::int16_t{});
      case Number::kUint16:
        return as(std::uint16_t{});
      case Number::kInt32:
        return as(std::int32_t{});
      case Number::kUint32:
        return as(std::uint32_t{});
      case Number::kFloat:
        return static_cast<double>(as(float{}));
      case Number::kDouble:
        break;
    }
    return as(double{});
  }

  std::string_view rest_;
  const std::string& file_;
  Encoding encoding_ = Encoding::kText;
  std::vector<Element> elements_;
  std::size_t line_ = 0;
  std::string place_;
  std::vector<std::string_view> words_;  // of a line of a text file
  std::size_t word_ = 0;
  std::vector<double> values_;
};

}  // namespace

PlyPoints read_ply_points(std::string_view content, const std::string& file) {
  return PlyReader(content, file).read();
}

}  // namespace spherule::internal
