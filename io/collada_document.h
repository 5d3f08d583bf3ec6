// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/scene_budget.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <utility>
#include <vector>

// The XML of a COLLADA file (Khronos, "COLLADA - Digital Asset Schema Release 1.5.0"), with checked
// access. What stands in <extra> and <technique> is data of other programs, and is not looked at.

namespace spherule::internal {

class ColladaDocument {
 public:
  using Element = tinyxml2::XMLElement;

  // `subject` names the file in an Error; it and the budget have to outlive the document. Throws
  // Error if the text is not well-formed XML, or is not COLLADA.
  ColladaDocument(std::string_view text, const std::string& subject, SceneBudget& budget);

  const Element& root() const { return *root_; }
  // Every <asset>, the document's too.
  const std::vector<const Element*>& assets() const { return assets_; }

  // The element of this name whose id a reference "#id" names. Throws Error if there is none or
  // more than one, and for a reference into another file.
  const Element& referred(const char* name, const Element& from, const char* attribute) const;
  const Element& with_id(const char* name, const std::string& id, const Element& from) const;

  // The child elements of this name, or all. Every child, comments too, is a step of the budget.
  std::vector<const Element*> children(const Element& parent, const char* name = nullptr) const;
  // The only child of this name, which has to be there.
  const Element& child(const Element& parent, const char* name) const;
  std::string text_attribute(const Element& element, const char* name) const;
  // A whole number that is not negative, `absent` if there is no such attribute.
  std::size_t whole_attribute(const Element& element, const char* name, std::size_t absent) const;

  // What stands in an element, nothing but white space and comments between. Each is a step of the
  // budget.
  std::vector<double> numbers(const Element& element) const;
  std::vector<std::int64_t> whole_numbers(const Element& element) const;
  std::vector<std::string> words(const Element& element) const;

  // Throws Error with the line of the element.
  [[noreturn]] void fail(const Element& element, const std::string& reason) const;

 private:
  void index(const Element& element);
  std::string text(const Element& element) const;
  std::vector<std::string_view> split(std::string_view text) const;

  const std::string& subject_;
  SceneBudget& budget_;
  tinyxml2::XMLDocument document_;
  const Element* root_ = nullptr;
  std::vector<const Element*> assets_;
  // By name and id; null if several elements share them.
  std::map<std::pair<std::string, std::string>, const Element*> ids_;
};

}  // namespace spherule::internal
