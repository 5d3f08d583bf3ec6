// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply_data.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace spherule::internal {
namespace {

// Of elements, and of properties of an element; a name is compared with all before it.
constexpr std::size_t kMaxNames = 1000;

struct Range {
  double least;
  double most;
};

// Of a type of whole numbers.
Range range_of(NumberType type) {
  const double values = std::exp2(8.0 * static_cast<double>(size_of(type)));
  const bool is_signed =
      type == NumberType::kInt8 || type == NumberType::kInt16 || type == NumberType::kInt32;
  return is_signed ? Range{-values / 2.0, values / 2.0 - 1.0} : Range{0.0, values - 1.0};
}

bool is_in_range(double value, NumberType type) {
  const Range range = range_of(type);
  return value >= range.least && value <= range.most && value == std::floor(value);
}

}  // namespace

bool is_not_finite(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  std::string lower(word.substr(0, 9));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower == "nan" || lower.starts_with("nan(") || lower == "inf" || lower == "infinity";
}

PlyData::PlyData(std::string_view bytes, const std::string& subject)
    : bytes_(bytes), in_(bytes, subject) {
  read_header();
}

void PlyData::read_header() {
  if (in_.token() != "ply") in_.fail("not a PLY file: it does not begin with 'ply'");
  in_.expect_line_end();
  const std::size_t first_end = in_.position();
  bool has_format = false;
  for (std::string_view word = in_.token(); word != "end_header"; word = in_.token()) {
    if (word == "comment" || word == "obj_info") {
      in_.skip_line();
      continue;
    }
    if (word == "format") {
      read_format();
      has_format = true;
    } else if (word == "element") {
      read_element();
    } else if (word == "property") {
      read_property();
    } else {
      in_.fail(word.empty() ? "the header is cut short" : "the header is broken");
    }
    in_.expect_line_end();
  }
  if (!has_format) in_.fail("the header names no format");
  for (const PlyElement& element : elements_) {
    if (element.properties.empty()) {
      in_.fail("the element " + in_quotes(element.name) + " has no properties");
    }
  }
  in_.expect_line_end();
  at_ = in_.position();
  // Where lines end in CR alone, a line feed after the last one is data.
  const bool may_be_two = bytes_.substr(first_end, 1) != "\r" || bytes_[first_end + 1] == '\n';
  at_ += may_be_two && bytes_.substr(at_).starts_with("\r\n") ? 2 : at_ < bytes_.size() ? 1 : 0;
}

void PlyData::read_format() {
  const std::string_view format = in_.token_on_line();
  if (format == "binary_little_endian") {
    byte_order_ = std::endian::little;
  } else if (format == "binary_big_endian") {
    byte_order_ = std::endian::big;
  } else if (format != "ascii") {
    in_.fail(in_quotes(format) + " is not a PLY format");
  }
  const std::string_view version = in_.token_on_line();
  if (version != "1.0") in_.fail(in_quotes(version) + " is not version 1.0 of the format");
}

void PlyData::read_element() {
  const std::string name(in_.token_on_line());
  if (name.empty()) in_.fail("an element without a name");
  const std::int64_t count = in_.integer(in_.token_on_line());
  // Each item takes at least a byte.
  if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size()) {
    in_.fail("the file cannot hold " + std::to_string(count) + " items of " + in_quotes(name));
  }
  const auto is_same = [&](const PlyElement& other) { return other.name == name; };
  if (elements_.size() == kMaxNames) in_.fail("more than 1000 elements");
  if (std::ranges::any_of(elements_, is_same)) {
    in_.fail("the element " + in_quotes(name) + " is there twice");
  }
  elements_.push_back({name, static_cast<std::size_t>(count), {}});
}

void PlyData::read_property() {
  if (elements_.empty()) in_.fail("a property of nothing");
  PlyProperty property;
  std::string_view type = in_.token_on_line();
  if (type == "list") {
    property.count_type = read_type(in_.token_on_line());
    if (*property.count_type >= NumberType::kFloat) in_.fail("a list of fractional length");
    type = in_.token_on_line();
  }
  property.type = read_type(type);
  property.name = in_.token_on_line();
  if (property.name.empty()) in_.fail("a property without a name");
  std::vector<PlyProperty>& properties = elements_.back().properties;
  const auto is_same = [&](const PlyProperty& other) { return other.name == property.name; };
  if (properties.size() == kMaxNames) in_.fail("an element of more than 1000 properties");
  if (std::ranges::any_of(properties, is_same)) {
    in_.fail("the property " + in_quotes(property.name) + " is there twice");
  }
  properties.push_back(std::move(property));
}

NumberType PlyData::read_type(std::string_view word) const {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                      {"uchar", "uint8"},
                                                                      {"short", "int16"},
                                                                      {"ushort", "uint16"},
                                                                      {"int", "int32"},
                                                                      {"uint", "uint32"},
                                                                      {"float", "float32"},
                                                                      {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<NumberType>(i);
  }
  in_.fail(in_quotes(word) + " is not a type of number");
}

void PlyData::begin_item(const PlyElement& element, std::size_t number) {
  element_ = &element;
  number_ = number;
  is_line_begun_ = false;
}

void PlyData::end_item() {
  if (is_text() && !in_.token_on_line().empty()) fail(item() + " has too many numbers");
}

std::string PlyData::item() const {
  return element_->name + " " + std::to_string(number_);
}

std::string_view PlyData::next_word() {
  const std::string_view token = is_line_begun_ ? in_.token_on_line() : in_.token();
  is_line_begun_ = true;
  if (token.empty()) fail(item() + " has too few numbers");
  return token;
}

double PlyData::next(NumberType type, NonFinite non_finite) {
  if (is_text()) {
    const std::string_view word = next_word();
    if (non_finite == NonFinite::kRead && type >= NumberType::kFloat && is_not_finite(word)) {
      return std::nan("");
    }
    const double value = in_.number(word);
    if (type < NumberType::kFloat && !is_in_range(value, type)) {
      fail(in_quotes(word) + " is not a whole number from " + number_text(range_of(type).least) +
           " to " + number_text(range_of(type).most) + ", as its type says");
    }
    return value;
  }
  const std::size_t begin = at_;
  if (bytes_.size() - begin < size_of(type)) fail("the file is cut short in " + item());
  at_ += size_of(type);
  return number_at(bytes_.data() + begin, type, *byte_order_);
}

std::int64_t PlyData::next_integer(NumberType type) {
  const double value = next(type);
  if (!(std::abs(value) <= 0x1p32) || value != std::floor(value)) fail("a whole number expected");
  return static_cast<std::int64_t>(value);
}

std::size_t PlyData::next_list_size(const PlyProperty& property) {
  const std::int64_t size = next_integer(*property.count_type);
  if (size < 0 || static_cast<std::uint64_t>(size) > bytes_.size()) fail("a list of bad length");
  return static_cast<std::size_t>(size);
}

void PlyData::next_list(const PlyProperty& property, std::vector<std::int64_t>& list) {
  list.resize(next_list_size(property));
  for (std::int64_t& value : list) value = next_integer(property.type);
}

void PlyData::skip(const PlyProperty& property) {
  const std::size_t count = property.count_type ? next_list_size(property) : 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_text()) {
      next_word();
    } else {
      next(property.type);
    }
  }
}

void PlyData::skip(const PlyElement& element) {
  for_each_item(element, [&] {
    for (const PlyProperty& property : element.properties) skip(property);
  });
}

std::vector<Eigen::Vector3d> PlyData::read_points(const PlyElement& element, NonFinite non_finite) {
  const auto is_axis = [](const PlyProperty& p) {
    return !p.count_type && (p.name == "x" || p.name == "y" || p.name == "z");
  };
  if (std::ranges::count_if(element.properties, is_axis) != 3) {
    fail("the vertices lack one of x, y and z");
  }
  std::vector<Eigen::Vector3d> points;
  for_each_item(element, [&] {
    Eigen::Vector3d& point = points.emplace_back(Eigen::Vector3d::Zero());
    for (const PlyProperty& p : element.properties) {
      if (is_axis(p)) {
        point[p.name[0] - 'x'] = next(p.type, non_finite);
      } else {
        skip(p);
      }
    }
  });
  return points;
}

void PlyData::expect_end() {
  const bool is_end = is_text() ? in_.token().empty() : at_ == bytes_.size();
  if (!is_end) fail("more data than the header says");
}

void PlyData::fail(const std::string& reason) const {
  if (is_text()) in_.fail(reason);
  throw Error(in_.subject(), "byte " + std::to_string(at_) + ": " + reason);
}

}  // namespace spherule::internal
