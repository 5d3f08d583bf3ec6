// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/geometry/raw_mesh.h"
#include "mesh/io/internal/text_scanner.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

namespace spherule::internal {
namespace {

enum class NumberType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct Property {
  std::string name;
  NumberType type = NumberType::kFloat;      // of the items of a list
  std::optional<NumberType> list_size_type;  // only of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
  std::size_t end = 0;  // where the data begins
};

NumberType parse_type(const TextScanner& in, std::string_view word) {
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
  in.fail(in_quotes(word) + " is not a type of number");
}

Property parse_property(TextScanner& in) {
  Property property;
  std::string_view type = in.token_on_line();
  if (type == "list") {
    property.list_size_type = parse_type(in, in.token_on_line());
    if (*property.list_size_type >= NumberType::kFloat) in.fail("a list of fractional length");
    type = in.token_on_line();
  }
  property.type = parse_type(in, type);
  property.name = in.token_on_line();
  return property;
}

Header parse_header(TextScanner& in, std::string_view bytes) {
  Header header;
  if (in.token() != "ply") in.fail("not a PLY file");
  bool has_format = false;
  for (std::string_view word = in.token(); word != "end_header"; word = in.token()) {
    if (word == "format") {
      const std::string_view format = in.token_on_line();
      has_format = true;
      if (format == "binary_little_endian") {
        header.encoding = Encoding::kLittleEndian;
      } else if (format == "binary_big_endian") {
        header.encoding = Encoding::kBigEndian;
      } else if (format != "ascii") {
        in.fail(in_quotes(format) + " is not a PLY format");
      }
    } else if (word == "element") {
      const std::string name(in.token_on_line());
      const std::int64_t count = in.integer(in.token_on_line());
      // Each item takes at least a byte.
      if (count < 0 || static_cast<std::uint64_t>(count) > bytes.size()) {
        in.fail("the file cannot hold " + std::to_string(count) + " items of " + in_quotes(name));
      }
      header.elements.push_back({name, static_cast<std::size_t>(count), {}});
    } else if (word == "property") {
      if (header.elements.empty()) in.fail("a property of nothing");
      header.elements.back().properties.push_back(parse_property(in));
    } else if (word != "comment" && word != "obj_info") {
      in.fail(word.empty() ? "the header is cut short" : "the header is broken");
    }
    in.skip_line();
  }
  if (!has_format) in.fail("the header names no format");
  header.end = std::min(bytes.size(), bytes.find('\n', in.position()));
  header.end = std::min(bytes.size(), header.end + 1);
  return header;
}

// Reads the numbers that follow the header, in text or binary form, one after the other.
class Numbers {
 public:
  Numbers(TextScanner& in, std::string_view bytes, const Header& header)
      : in_(in), bytes_(bytes), encoding_(header.encoding), at_(header.end) {}

  double next(NumberType type) {
    if (encoding_ == Encoding::kText) return in_.number();
    switch (type) {
      case NumberType::kInt8:
        return raw<std::int8_t>();
      case NumberType::kUint8:
        return raw<std::uint8_t>();
      case NumberType::kInt16:
        return raw<std::int16_t>();
      case NumberType::kUint16:
        return raw<std::uint16_t>();
      case NumberType::kInt32:
        return raw<std::int32_t>();
      case NumberType::kUint32:
        return raw<std::uint32_t>();
      case NumberType::kFloat:
        return raw<float>();
      case NumberType::kDouble:
        break;
    }
    return raw<double>();
  }

  std::int64_t next_integer(NumberType type) {
    const double value = next(type);
    if (!(std::abs(value) <= 0x1p32) || value != std::floor(value)) fail("a whole number expected");
    return static_cast<std::int64_t>(value);
  }

  std::size_t next_list_size(const Property& property) {
    const std::int64_t size = next_integer(*property.list_size_type);
    if (size < 0 || static_cast<std::uint64_t>(size) > bytes_.size()) fail("a list of bad length");
    return static_cast<std::size_t>(size);
  }

  void expect_end() const {
    const bool text = encoding_ == Encoding::kText;
    if (text ? !in_.token().empty() : at_ != bytes_.size()) fail("more data than the header says");
  }

  [[noreturn]] void fail(const std::string& reason) const {
    if (encoding_ == Encoding::kText) in_.fail(reason);
    throw Error(in_.subject(), "byte " + std::to_string(at_) + ": " + reason);
  }

 private:
  template <class T>
  double raw() {
    std::array<char, sizeof(T)> image;
    if (bytes_.size() - at_ < image.size()) fail("the file is cut short");
    std::memcpy(image.data(), bytes_.data() + at_, image.size());
    at_ += image.size();
    const bool big = encoding_ == Encoding::kBigEndian;
    if (big != (std::endian::native == std::endian::big)) std::reverse(image.begin(), image.end());
    return static_cast<double>(std::bit_cast<T>(image));
  }

  TextScanner& in_;
  std::string_view bytes_;
  Encoding encoding_;
  std::size_t at_;
};

void read_list(Numbers& numbers, const Property& property, std::vector<std::int64_t>& list) {
  list.resize(numbers.next_list_size(property));
  for (std::int64_t& value : list) value = numbers.next_integer(property.type);
}

void skip(Numbers& numbers, const Property& property) {
  const std::size_t count = property.list_size_type ? numbers.next_list_size(property) : 1;
  for (std::size_t i = 0; i < count; ++i) numbers.next(property.type);
}

void read_vertices(Numbers& numbers, const Element& element, TriangleMesh& mesh) {
  int axes = 0;
  for (const Property& p : element.properties) {
    axes += !p.list_size_type && (p.name == "x" || p.name == "y" || p.name == "z");
  }
  if (axes != 3) numbers.fail("the vertices lack one of x, y and z");
  for (std::size_t i = 0; i < element.count; ++i) {
    Eigen::Vector3d& v = mesh.vertices.emplace_back(Eigen::Vector3d::Zero());
    for (const Property& p : element.properties) {
      const bool axis =
          !p.list_size_type && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z';
      if (axis) {
        v[p.name[0] - 'x'] = numbers.next(p.type);
      } else {
        skip(numbers, p);
      }
    }
  }
}

// A strip makes a triangle of each corner and the two before it, turned over every second time; -1
// begins a new strip.
void add_strip(const std::vector<std::int64_t>& strip, Numbers& numbers,
               std::vector<std::vector<std::int64_t>>& faces) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == -1) {
      begin = i + 1;
    } else if (strip[i] < 0) {
      numbers.fail("a strip refers to a negative vertex");
    } else if (i >= begin + 2) {
      const bool turned = (i - begin) % 2 == 1;
      faces.push_back({strip[turned ? i - 1 : i - 2], strip[turned ? i - 2 : i - 1], strip[i]});
    }
  }
}

void read_faces(Numbers& numbers, const Element& element,
                std::vector<std::vector<std::int64_t>>& faces) {
  const auto is_corners = [](const Property& p) {
    return p.list_size_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (std::none_of(element.properties.begin(), element.properties.end(), is_corners)) {
    numbers.fail(in_quotes(element.name) + " lacks the list vertex_indices");
  }
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const Property& p : element.properties) {
      if (!is_corners(p)) {
        skip(numbers, p);
        continue;
      }
      read_list(numbers, p, corners);
      if (element.name == "face") {
        faces.push_back(corners);
      } else {
        add_strip(corners, numbers, faces);
      }
    }
  }
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& subject) {
  TextScanner in(bytes, subject);
  const Header header = parse_header(in, bytes);
  Numbers numbers(in, bytes, header);
  TriangleMesh mesh;
  std::vector<std::vector<std::int64_t>> faces;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(numbers, element, mesh);
    } else if (element.name == "face" || element.name == "tristrips") {
      read_faces(numbers, element, faces);
    } else {
      for (std::size_t i = 0; i < element.count; ++i) {
        for (const Property& p : element.properties) skip(numbers, p);
      }
    }
  }
  numbers.expect_end();
  for (const std::vector<std::int64_t>& corners : faces) {
    add_polygon(mesh, corners, mesh.vertices.size(), subject);
  }
  if (header.encoding == Encoding::kText) {
    mesh.vertex_error = rounding_distance(largest_coordinate(mesh), kUnitRoundoff);
  }
  return mesh;
}

}  // namespace spherule::internal
