// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/text_scanner.h"
#include "io/binary_number.h"

#include <Eigen/Core>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::kFloat;  // of the items of a list
  std::optional<NumberType> count_type;  // of the length of a list; only lists have it
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;  // of its items
  std::vector<PlyProperty> properties;
};

// Whether a word stands for what is no number or not finite ("nan", "-inf").
bool is_not_finite(std::string_view word);

// What of numbers in text that are not finite; in binary form they are always read.
enum class NonFinite { kRefused, kRead };

// The header of a PLY file (Turk, "The PLY Polygon File Format", 1994), then its numbers one after
// the other, in text or binary form. In text each item stands on a line of its own. Every fault is
// an Error that names the file and the line, or the byte.
class PlyData {
 public:
  // Reads the header. The bytes have to outlive this.
  PlyData(std::string_view bytes, const std::string& subject);

  const std::vector<PlyElement>& elements() const { return elements_; }
  bool is_text() const { return !byte_order_; }
  const std::string& subject() const { return in_.subject(); }

  // Calls `read` once for each item of the element, which has to read all of its properties.
  template <class Read>
  void for_each_item(const PlyElement& element, const Read& read) {
    for (std::size_t i = 0; i < element.count; ++i) {
      begin_item(element, i);
      read();
      end_item();
    }
  }

  // The next number of the item; finite and in the range of its type if the file is text.
  double next(NumberType type) { return next(type, NonFinite::kRefused); }
  std::int64_t next_integer(NumberType type);
  // The list that comes next, or its length alone.
  void next_list(const PlyProperty& property, std::vector<std::int64_t>& list);
  std::size_t next_list_size(const PlyProperty& property);
  // Whatever stands there instead of numbers, if the file is text.
  void skip(const PlyProperty& property);

  // All items of an element: without their values, or as points by their properties x, y and z.
  void skip(const PlyElement& element);
  std::vector<Eigen::Vector3d> read_points(const PlyElement& element,
                                           NonFinite non_finite = NonFinite::kRefused);
  void expect_end();

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void read_header();
  void read_format();
  void read_element();
  void read_property();
  NumberType read_type(std::string_view word) const;

  void begin_item(const PlyElement& element, std::size_t number);
  void end_item();
  std::string_view next_word();  // in text form
  double next(NumberType type, NonFinite non_finite);
  std::string item() const;  // the name of the current one

  std::string_view bytes_;
  TextScanner in_;                         // of the header, and of all in text form
  std::optional<std::endian> byte_order_;  // in binary form
  std::vector<PlyElement> elements_;
  std::size_t at_ = 0;  // in binary form: the next byte
  const PlyElement* element_ = nullptr;
  std::size_t number_ = 0;  // of the current item
  bool is_line_begun_ = false;
};

}  // namespace spherule::internal
