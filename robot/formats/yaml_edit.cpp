// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/yaml_edit.h"

#include <algorithm>

namespace spherule::internal {
namespace {

using YAML::Node;

constexpr std::string_view kBlank = " \t\r\n";

bool is_blank(std::string_view text) {
  return text.find_first_not_of(kBlank) == std::string_view::npos;
}

bool is_comment(std::string_view text) {
  const std::size_t start = text.find_first_not_of(kBlank);
  return start == std::string_view::npos || text[start] == '#';
}

// Whether a line ends the document, which no value goes beyond.
bool ends_document(std::string_view line) {
  return line.starts_with("...") && is_comment(line.substr(3));
}

// How long the word is with which a text says that there is no value; 0 if it says nothing.
std::size_t length_of_null(std::string_view text) {
  for (const std::string_view word : {"null", "Null", "NULL", "~"}) {
    if (text.starts_with(word) && is_comment(text.substr(word.size()))) return word.size();
  }
  return 0;
}

// "a, b".
std::string joined(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text.append(text.empty() ? "" : ", ").append(item);
  return text;
}

}  // namespace

YamlEdit::YamlEdit(std::string_view text) : text_(text), lines_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') lines_.push_back(i + 1);
  }
  if (lines_.size() > 1 && text.substr(0, lines_[1]).ends_with("\r\n")) line_end_ = "\r\n";
}

bool YamlEdit::require(bool holds) {
  is_possible_ = is_possible_ && holds;
  return is_possible_;
}

// Ends of lines are written as those of the text are.
void YamlEdit::change(std::size_t begin, std::size_t end, const std::string& text) {
  std::string written;
  for (const char c : text) written.append(c == '\n' ? line_end_ : std::string_view(&c, 1));
  changes_.push_back({begin, end, std::move(written)});
}

std::string YamlEdit::result() const {
  std::vector<Change> changes = changes_;
  std::stable_sort(changes.begin(), changes.end(),
                   [](const Change& a, const Change& b) { return a.begin < b.begin; });
  std::string result;
  std::size_t at = 0;
  for (const Change& change : changes) {
    if (change.begin > at) result.append(text_.substr(at, change.begin - at));
    const bool is_at_end = change.begin == text_.size() && !result.empty();
    if (is_at_end && result.back() != '\n') result += line_end_;
    result += change.text;
    at = std::max(at, change.end);
  }
  return result.append(text_.substr(at));
}

std::size_t YamlEdit::line_start(std::size_t line) const {
  return line < lines_.size() ? lines_[line] : text_.size();
}

std::string_view YamlEdit::line(std::size_t index) const {
  return text_.substr(line_start(index), line_start(index + 1) - line_start(index));
}

std::size_t YamlEdit::offset(const Node& node) const {
  const YAML::Mark mark = node.Mark();
  if (mark.is_null()) return text_.size();
  const std::size_t start = line_start(static_cast<std::size_t>(mark.line));
  return std::min(text_.size(), start + static_cast<std::size_t>(mark.column));
}

std::optional<std::size_t> YamlEdit::end_of_scalar(const Node& scalar) const {
  if (!scalar.IsScalar() || scalar.Scalar().empty()) return std::nullopt;
  const std::string& value = scalar.Scalar();
  const std::size_t start = offset(scalar);
  for (const std::string& written : {value, '"' + value + '"', "'" + value + "'"}) {
    if (text_.substr(start).starts_with(written)) return start + written.size();
  }
  return std::nullopt;
}

std::optional<std::size_t> YamlEdit::colon_after(const Node& key) const {
  const auto end = end_of_scalar(key);
  if (!end) return std::nullopt;
  const std::size_t colon = text_.find_first_not_of(" ", *end);
  if (colon == std::string_view::npos || text_[colon] != ':') return std::nullopt;
  return colon;
}

std::size_t YamlEdit::column(const Node& key) {
  const std::size_t at = offset(key);
  const std::size_t start = line_start(static_cast<std::size_t>(std::max(0, key.Mark().line)));
  require(text_.substr(start, at - start).find_first_not_of(' ') == std::string_view::npos);
  return at - start;
}

// Comments and empty lines below the value, and the end of the document, belong to what follows.
std::size_t YamlEdit::line_after_value(const YamlPlace& place) const {
  const auto first = static_cast<std::size_t>(place.key.Mark().line);
  std::size_t after =
      place.next ? static_cast<std::size_t>(place.next->Mark().line) : lines_.size();
  while (after > first + 1 && (is_comment(line(after - 1)) || ends_document(line(after - 1)))) {
    --after;
  }
  return after;
}

void YamlEdit::replace_by_block(const YamlPlace& place, const std::string& block) {
  column(place.key);
  const auto colon = colon_after(place.key);
  if (!require(colon.has_value())) return;
  if (place.next) column(*place.next);
  const auto first = static_cast<std::size_t>(place.key.Mark().line);
  const std::size_t end = line_start(line_after_value(place));
  const std::string_view behind = line(first).substr(*colon + 1 - line_start(first));
  if (is_comment(behind)) {
    change(line_start(first + 1), end, block);
  } else {
    change(*colon + 1, end, "\n" + block);
  }
}

void YamlEdit::add_above(const Node& node, const std::string& lines) {
  const std::size_t start = line_start(static_cast<std::size_t>(std::max(0, node.Mark().line)));
  change(start, start, lines);
}

void YamlEdit::add_below(const YamlPlace& place, const std::string& lines) {
  if (place.next) column(*place.next);
  const std::size_t at = line_start(line_after_value(place));
  change(at, at, lines);
}

void YamlEdit::append_to_block(const Node& list, const std::vector<std::string>& items,
                               const std::vector<std::string>& item_comments) {
  const Node last = list[list.size() - 1];
  const auto index = static_cast<std::size_t>(std::max(0, last.Mark().line));
  const std::string dash(text_.substr(line_start(index), offset(last) - line_start(index)));
  const std::size_t at = dash.find_first_not_of(' ');
  if (!require(at != std::string::npos && dash[at] == '-' && is_blank(dash.substr(at + 1)))) return;
  std::string lines;
  for (std::size_t i = 0; i < items.size(); ++i) {
    lines += dash + items[i];
    if (!item_comments.empty()) lines += "  # " + item_comments[i];
    lines += "\n";
  }
  change(line_start(index + 1), line_start(index + 1), lines);
}

void YamlEdit::append(const YamlPlace& place, const std::vector<std::string>& items,
                      const std::vector<std::string>& item_comments, const std::string& comment) {
  const Node& list = place.value;
  if (!require(list.IsSequence() || list.IsNull())) return;
  if (list.size() > 0) {
    const auto end = end_of_scalar(list[list.size() - 1]);
    if (!require(end.has_value())) return;
    if (list.Style() == YAML::EmitterStyle::Block) {
      append_to_block(list, items, item_comments);
      return;
    }
    change(*end, *end, ", " + joined(items));
  } else if (list.IsSequence()) {
    const std::size_t open = offset(list);
    if (!require(open < text_.size() && text_[open] == '[')) return;
    change(open + 1, open + 1, joined(items));
  } else {
    const auto colon = colon_after(place.key);
    if (!require(colon.has_value())) return;
    const std::size_t end = line_start(static_cast<std::size_t>(place.key.Mark().line) + 1);
    const std::size_t value = text_.find_first_not_of(' ', *colon + 1);
    const std::string_view rest = value < end ? text_.substr(value, end - value) : "";
    const std::size_t length = length_of_null(rest);
    if (!require(length > 0 || is_comment(rest))) return;
    change(*colon + 1, length > 0 ? value + length : *colon + 1, " [" + joined(items) + "]");
  }
  if (comment.empty()) return;
  const std::string_view above = line(static_cast<std::size_t>(place.key.Mark().line));
  const std::string indent(above.substr(0, above.find_first_not_of(' ')));
  add_above(place.key, indent + comment + "\n");
}

void YamlEdit::add_in_braces(const Node& map, const std::string& lines, std::size_t indent) {
  const std::size_t open = offset(map);
  if (!require(open < text_.size() && text_[open] == '{')) return;
  const auto index = static_cast<std::size_t>(map.Mark().line);
  const std::size_t next_line = line_start(index + 1);
  if (is_comment(text_.substr(open + 1, next_line - open - 1))) {
    change(next_line, next_line, lines);
  } else {
    change(open + 1, open + 1, "\n" + lines + std::string(indent, ' '));
  }
}

}  // namespace spherule::internal
