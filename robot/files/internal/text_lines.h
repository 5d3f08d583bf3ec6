// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace spherule::internal {

// The lines of a text table that have something on them: words apart by blanks, tabs, commas or
// semicolons; what follows a # is no part of a line. An empty cell, between two commas, is an empty
// word. A byte order mark at the beginning is passed over.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  // The next line with words; false at the end.
  bool next();
  // Of that line, counted from 1.
  std::size_t number() const { return number_; }
  const std::vector<std::string_view>& words() const { return words_; }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace spherule::internal
