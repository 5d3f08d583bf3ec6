// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Numbers and names in text files of other tools.

#include "geometry/sphere.h"

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

// A finite number as a decimal with a point and without an exponent (which YAML 1.1 reads as a
// text where it has no point), the shortest that reads back to the same double.
std::string decimal(double value);

// Three of them, apart by `separator`.
std::string decimals(const Eigen::Vector3d& point, std::string_view separator);

// Why a text cannot be a name in every format, or nothing: XML and YAML have no way to write some
// characters.
std::string fault_of_name(std::string_view name);

// Whether a text can be nothing but a text to a reader of YAML 1.1 or 1.2 without quotes: a letter,
// then letters, digits and a few signs, and no word for a truth value, a number or nothing.
bool is_plain_yaml(std::string_view text);

bool is_utf8(std::string_view text);

// The lines of a text table that have something on them: words apart by blanks, tabs, commas or
// semicolons; what follows a # is no part of a line. An empty cell, between two commas, is an empty
// word. A byte order mark at the beginning is passed over. Lines end as take_line() says.
class TextLines {
 public:
  // Of a line with more words than `columns` only so many are of interest.
  TextLines(std::string_view text, std::string file,
            std::size_t columns = std::numeric_limits<std::size_t>::max())
      : rest_(text), file_(std::move(file)), columns_(columns) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  // From the next line on.
  void look_at(std::size_t columns) { columns_ = columns; }

  // The next line with words; false at the end. Throws Error for a line in which commas may be
  // those of decimals, as far as it is of interest: beside semicolons, or beside blanks that
  // separate.
  bool next();
  // Of that line, counted from 1.
  std::size_t number() const { return number_; }
  const std::vector<std::string_view>& words() const { return words_; }
  // Throws Error naming the file and that line.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  std::string_view rest_;
  std::string file_;
  std::size_t columns_;
  std::size_t number_ = 0;
  std::vector<std::string_view> words_;
};

// The spheres of a SPHERES.json file, for robots and scenes, which are in metres. Throws Error as
// load_spheres() does, and for spheres that are in another unit, as the options of their fit say;
// where these name none, the numbers are taken as metres.
std::vector<Sphere> load_spheres_in_metres(const std::filesystem::path& path);

}  // namespace spherule::internal
