// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Changes to the text of a YAML document that leave all other bytes as they are.

#include "robot/formats/yaml_nodes.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// Where a member of a map stands: its key, its value, and the key that follows in the document,
// of the same map or of one around it (none for the last).
struct YamlPlace {
  YAML::Node key;
  YAML::Node value;
  std::optional<YAML::Node> next = std::nullopt;
};

// Collects changes to a text and makes them all. What the changes take for granted of the text (a
// key at the start of its line, a text that is written without escapes) is examined; where it is
// not so, is_possible() is false from then on. Whoever uses the result reads it again.
class YamlEdit {
 public:
  explicit YamlEdit(std::string_view text);

  // The column of a key that is the first thing on its line.
  std::size_t column(const YAML::Node& key);

  // Replaces the value of a key by a block of lines, each ended. Comments behind a key without a
  // value on its line, and below the value, stay.
  void replace_by_block(const YamlPlace& place, const std::string& block);
  // Adds lines above the line of a node, or below the value of a member.
  void add_above(const YAML::Node& node, const std::string& lines);
  void add_below(const YamlPlace& place, const std::string& lines);
  // Adds items, as they are written, to a list: of one that is a block on lines of their own, each
  // with a comment if there are any; of others on the line of the last one, with `comment` on a
  // line above the key.
  void append(const YamlPlace& list, const std::vector<std::string>& items,
              const std::vector<std::string>& item_comments, const std::string& comment);
  // Adds lines at the start of a map in braces; `indent` is the column in which they stand.
  void add_in_braces(const YAML::Node& map, const std::string& lines, std::size_t indent);

  bool is_possible() const { return is_possible_; }
  // The text with all changes.
  std::string result() const;

 private:
  struct Change {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string text;
  };

  std::size_t line_start(std::size_t line) const;
  std::size_t offset(const YAML::Node& node) const;
  std::string_view line(std::size_t index) const;
  std::optional<std::size_t> end_of_scalar(const YAML::Node& scalar) const;
  std::optional<std::size_t> colon_after(const YAML::Node& key) const;
  std::size_t line_after_value(const YamlPlace& place) const;
  void append_to_block(const YAML::Node& list, const std::vector<std::string>& items,
                       const std::vector<std::string>& item_comments);
  // Notes that something is not as it must be, if so.
  bool require(bool holds);
  void change(std::size_t begin, std::size_t end, const std::string& text);

  std::string_view text_;
  std::string_view line_end_ = "\n";
  std::vector<std::size_t> lines_;  // where each starts
  std::vector<Change> changes_;
  bool is_possible_ = true;
};

}  // namespace spherule::internal
