// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule::internal {

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

}  // namespace spherule::internal
