// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/text_lines.h"

#include "spheretree/error.h"
#include "spheretree/text/text.h"

#include <algorithm>

namespace spherule::internal {
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

}  // namespace spherule::internal
