// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/text_lines.h"

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
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    line = trimmed(line.substr(0, std::min(line.find('#'), line.size())));
    if (line.empty()) continue;
    words_.clear();
    split(line, words_);
    return true;
  }
  return false;
}

}  // namespace spherule::internal
