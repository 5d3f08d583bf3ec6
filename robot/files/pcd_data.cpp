// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/pcd_data.h"

#include "base/bytes.h"
#include "base/error.h"
#include "base/text.h"
#include "base/text_scanner.h"
#include "io/ply_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostFields = 1000;
constexpr std::int64_t kMostOfAField = std::int64_t{1} << 20;
constexpr std::uint64_t kMostUnpacked = std::uint64_t{1} << 29;
constexpr std::uint64_t kMostUnpackedPoints = std::uint64_t{1} << 26;

struct Field {
  std::string_view name;
  char type = 'F';
  std::size_t size = 4;
  std::size_t count = 1;
  std::size_t before = 0;        // numbers of a point
  std::size_t bytes_before = 0;  // of a point

  std::size_t bytes() const { return size * count; }
};

// A number as it is stored, in the byte order of all machines that write such files.
double number_of(const Field& field, const char* bytes) {
  const auto as = [&](auto kind) { return static_cast<double>(number_at<decltype(kind)>(bytes)); };
  if (field.type == 'F') return field.size == 4 ? as(float{}) : as(double{});
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
    case 2:
      return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
    case 4:
      return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
    default:
      return is_signed ? as(std::int64_t{}) : as(std::uint64_t{});
  }
}

bool is_in_range(double value, const Field& field) {
  if (field.type == 'F') return true;
  const double values = std::exp2(8.0 * static_cast<double>(field.size));
  const double least = field.type == 'I' ? -values / 2.0 : 0.0;
  return value == std::floor(value) && value >= least && value < least + values;
}

class PcdReader {
 public:
  PcdReader(std::string_view bytes, const std::string& file)
      : bytes_(bytes), in_(bytes, file, {.comment = '#'}) {}

  PcdPoints run() {
    const std::string_view form = read_header();
    place_fields();
    PcdPoints result;
    result.is_rounded = std::any_of(axes_.begin(), axes_.end(), [](const Field& field) {
      return field.type != 'F' && field.size == 8;
    });
    if (form == "ascii") {
      result.is_rounded = true;
      result.points = text_points();
    } else if (form == "binary") {
      if (count_ > (bytes_.size() - at_) / point_bytes_) fail("the file is cut short");
      result.points = binary_points(take(count_ * point_bytes_));
    } else if (form == "binary_compressed") {
      result.points = compressed_points();
    } else {
      in_.fail(in_quotes(form) + " is no form of data: ascii, binary or binary_compressed");
    }
    return result;
  }

 private:
  // Up to the form of the data, which is returned.
  std::string_view read_header() {
    std::set<std::string_view> seen;
    std::int64_t width = -1, height = 1, points = -1;
    for (;;) {
      std::string_view key = in_.token();
      if (key.empty()) in_.fail("the header is cut short: 'DATA' is missing");
      if (key == "COLUMNS") key = "FIELDS";
      if (!seen.insert(key).second) in_.fail(in_quotes(key) + " is there twice");
      if (key == "VERSION" || key == "VIEWPOINT") {
        in_.skip_line();
        continue;
      }
      if (key == "FIELDS") {
        for (std::string_view w = word(); !w.empty(); w = word()) fields_.push_back({.name = w});
        if (fields_.size() > kMostFields) in_.fail("more than 1000 fields");
      } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
        for (Field& field : fields_) read_property(key, field);
      } else if (key == "WIDTH") {
        width = number_of_points();
      } else if (key == "HEIGHT") {
        height = number_of_points();
      } else if (key == "POINTS") {
        points = number_of_points();
      } else if (key == "DATA") {
        const std::string_view form = word();
        in_.expect_line_end();
        for (const std::string_view needed : {"FIELDS", "SIZE", "TYPE"}) {
          if (!seen.contains(needed)) in_.fail("the header lacks " + in_quotes(needed));
        }
        if (width < 0 && points < 0) in_.fail("the header lacks 'POINTS'");
        // At most 2^62, as each is below 2^31.
        if (points < 0) points = width * height;
        if (points > std::numeric_limits<std::int32_t>::max()) {
          in_.fail("no usable number of points");
        }
        if (width >= 0 && width * height != points) {
          in_.fail("'POINTS' is not 'WIDTH' times 'HEIGHT'");
        }
        count_ = static_cast<std::size_t>(points);
        at_ = in_.position();
        at_ += bytes_.substr(at_).starts_with("\r\n") ? 2 : at_ < bytes_.size() ? 1 : 0;
        return form;
      } else {
        in_.fail(in_quotes(key) + " is no entry of a header");
      }
      in_.expect_line_end();
    }
  }

  std::string_view word() { return in_.token_on_line(); }

  std::int64_t number_of_points() {
    const std::int64_t value = in_.integer(word());
    if (value < 0 || value > std::numeric_limits<std::int32_t>::max()) {
      in_.fail("no usable number of points");
    }
    return value;
  }

  void read_property(std::string_view key, Field& field) {
    const std::string_view value = word();
    if (value.empty()) in_.fail("not as many numbers as 'FIELDS' has names");
    if (key == "TYPE") {
      if (value != "F" && value != "I" && value != "U") {
        in_.fail(in_quotes(value) + " is no type: F, I or U");
      }
      field.type = value[0];
      return;
    }
    const std::int64_t number = in_.integer(value);
    if (key == "COUNT") {
      if (number < 1 || number > kMostOfAField) in_.fail("no usable number of values of a field");
      field.count = static_cast<std::size_t>(number);
    } else {
      if (number != 1 && number != 2 && number != 4 && number != 8) {
        in_.fail(in_quotes(value) + " is no size of a number: 1, 2, 4 or 8");
      }
      field.size = static_cast<std::size_t>(number);
    }
  }

  void place_fields() {
    std::array<int, 3> found = {0, 0, 0};
    for (Field& field : fields_) {
      field.before = point_numbers_;
      field.bytes_before = point_bytes_;
      point_numbers_ += field.count;
      point_bytes_ += field.bytes();
      if (field.type == 'F' && field.size < 4) in_.fail("a fraction of less than 4 bytes");
      if (field.name != "x" && field.name != "y" && field.name != "z") continue;
      const auto axis = static_cast<std::size_t>(field.name[0] - 'x');
      axes_[axis] = field;
      found[axis] += field.count == 1 ? 1 : 2;
    }
    if (found != std::array{1, 1, 1}) in_.fail("'FIELDS' has not one x, one y and one z");
  }

  std::vector<Vector3d> text_points() {
    // Each number takes two bytes at least.
    if (count_ > bytes_.size() / 2) {
      in_.fail("the file cannot hold " + std::to_string(count_) + " points");
    }
    std::vector<Vector3d> points;
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < count_; ++i) {
      words.clear();
      for (std::string_view w = in_.token(); !w.empty(); w = word()) words.push_back(w);
      if (words.empty()) in_.fail("the file is cut short");
      if (words.size() != point_numbers_) {
        in_.fail("point " + std::to_string(i) + " has " + std::to_string(words.size()) +
                 " numbers, not " + std::to_string(point_numbers_));
      }
      Vector3d& point = points.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const Field& field = axes_[static_cast<std::size_t>(k)];
        const std::string_view text = words[field.before];
        const bool is_missing = field.type == 'F' && is_not_finite(text);
        point[k] = is_missing ? std::nan("") : in_.number(text);
        if (!is_missing && !is_in_range(point[k], field)) {
          in_.fail(in_quotes(text) + " is not of the type that is stated");
        }
      }
    }
    if (!in_.token().empty()) in_.fail("more data than the header says");
    return points;
  }

  // So many bytes, which are all that is left.
  std::string_view take(std::uint64_t size) const {
    if (bytes_.size() - at_ < size) fail("the file is cut short");
    if (bytes_.size() - at_ > size) fail("more data than the header says");
    return bytes_.substr(at_);
  }

  // Point after point.
  std::vector<Vector3d> binary_points(std::string_view data) const {
    return points_at(data, [this](const Field& field, std::size_t point) {
      return point * point_bytes_ + field.bytes_before;
    });
  }

  // Field after field, each of all points.
  std::vector<Vector3d> compressed_points() {
    constexpr std::size_t kSizes = 8;
    if (bytes_.size() - at_ < kSizes) fail("the file is cut short");
    const std::uint64_t packed = number_at<std::uint32_t>(bytes_.data() + at_);
    const std::uint64_t unpacked = number_at<std::uint32_t>(bytes_.data() + at_ + 4);
    // In this order: so the product has no overflow.
    if (std::max<std::uint64_t>(unpacked, point_bytes_) > kMostUnpacked ||
        count_ > kMostUnpackedPoints) {
      fail("it unpacks to more than 2^29 bytes or 2^26 points");
    }
    if (unpacked != count_ * point_bytes_) {
      fail("the size of the unpacked data is not that of the points");
    }
    at_ += kSizes;
    const std::string data = unpack(take(packed), static_cast<std::size_t>(unpacked));
    return points_at(data, [this](const Field& field, std::size_t point) {
      return count_ * field.bytes_before + point * field.bytes();
    });
  }

  template <class Place>
  std::vector<Vector3d> points_at(std::string_view data, const Place& place) const {
    std::vector<Vector3d> points(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      for (int k = 0; k < 3; ++k) {
        const Field& field = axes_[static_cast<std::size_t>(k)];
        points[i][k] = number_of(field, data.data() + place(field, i));
      }
    }
    return points;
  }

  // LZF (Lehmann, liblzf): a control byte below 32 goes before so many bytes and one more; another
  // one says, with the byte or two after it, how much of what is unpacked is repeated, and from how
  // far back.
  std::string unpack(std::string_view packed, std::size_t size) {
    constexpr std::size_t kMostYield = 88;  // 264 bytes from 3
    if (size > kMostYield * packed.size()) fail("so few bytes cannot yield what it says");
    std::string out;
    out.reserve(size);
    std::size_t i = 0;
    const auto next = [&] {
      if (i == packed.size()) fail_at(i, "the packed data are cut short");
      return static_cast<std::size_t>(static_cast<unsigned char>(packed[i++]));
    };
    const auto require_room = [&](std::size_t more) {
      if (more > size - out.size()) fail_at(i, "the packed data yield more than they say");
    };
    while (i < packed.size()) {
      const std::size_t control = next();
      if (control < 32) {
        const std::size_t literal = control + 1;
        if (literal > packed.size() - i) fail_at(i, "the packed data are cut short");
        require_room(literal);
        out.append(packed.substr(i, literal));
        i += literal;
        continue;
      }
      std::size_t length = control >> 5U;
      if (length == 7) length += next();
      const std::size_t back = ((control & 31U) << 8U) + next() + 1;
      length += 2;
      if (back > out.size()) fail_at(i, "the packed data refer to before their beginning");
      require_room(length);
      for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
    }
    if (out.size() != size) fail_at(i, "the packed data yield less than they say");
    return out;
  }

  [[noreturn]] void fail(const std::string& reason) const { fail_at(0, reason); }
  // So many bytes behind the current place.
  [[noreturn]] void fail_at(std::size_t behind, const std::string& reason) const {
    throw Error(in_.subject(), "byte " + std::to_string(at_ + behind) + ": " + reason);
  }

  std::string_view bytes_;
  TextScanner in_;
  std::vector<Field> fields_;
  std::array<Field, 3> axes_;      // x, y and z
  std::size_t point_numbers_ = 0;  // of a point
  std::size_t point_bytes_ = 0;    // of a point
  std::size_t count_ = 0;          // of the points
  std::size_t at_ = 0;             // in binary forms: the next byte
};

}  // namespace

PcdPoints read_pcd(std::string_view bytes, const std::string& file) {
  return PcdReader(bytes, file).run();
}

}  // namespace spherule::internal
