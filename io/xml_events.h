// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace spherule::internal {

// Attributes of one element.
class XmlAttributes {
 public:
  explicit XmlAttributes(const char* const* pairs) : pairs_(pairs) {}

  // Names within a namespace are "NAMESPACE|NAME". The text lives as long as the event.
  std::optional<std::string_view> find(std::string_view name) const;

 private:
  const char* const* pairs_;
};

class XmlHandler {
 public:
  virtual ~XmlHandler() = default;

  // Begin and end of an element, named as attributes are; `position` is the byte of the text. Text
  // between elements is left out. May throw.
  virtual void open(std::string_view name, const XmlAttributes& attributes,
                    std::size_t position) = 0;
  virtual void close() = 0;
};

// Throws Error if the text is not well-formed XML, is nested more than 200 deep, has a namespace of
// more than 1000 bytes or a large tag (fault_of_large_tag()), or has a document type (which may
// define entities; the formats that are read here forbid it), and what the handler throws.
void parse_xml(std::string_view text, const std::string& subject, XmlHandler& handler);

}  // namespace spherule::internal
