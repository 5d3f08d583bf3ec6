// SPDX-License-Identifier: BSD-3-Clause
#include "io/collada_document.h"

#include "base/error.h"
#include "base/parser_fault.h"
#include "base/text.h"

#include <limits>
#include <optional>
#include <utility>

namespace spherule::internal {
namespace {

using Element = ColladaDocument::Element;

// Elements may be written with the prefix of the namespace.
std::string_view local_name(const Element& element) {
  const std::string_view name = element.Name();
  return name.substr(name.rfind(':') + 1);
}

// Steps of the budget for the length of a text that is copied or compared.
std::size_t steps_for(std::string_view text) {
  return text.size() / 16;
}

}  // namespace

ColladaDocument::ColladaDocument(std::string_view text, const std::string& subject,
                                 SceneBudget& budget)
    : subject_(subject), budget_(budget), document_(true, tinyxml2::PRESERVE_WHITESPACE) {
  const std::string large = fault_of_large_tag(text);
  if (!large.empty()) throw Error(subject_, large);
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(subject_, xml_fault(document_.ErrorName(), document_.ErrorLineNum()));
  }
  root_ = document_.RootElement();
  if (root_ == nullptr || local_name(*root_) != "COLLADA") {
    throw Error(subject_, "not a mesh: not COLLADA");
  }
  index(*root_);
}

void ColladaDocument::index(const Element& element) {
  for (const Element* at = element.FirstChildElement(); at != nullptr;
       at = at->NextSiblingElement()) {
    const std::string_view name = at->Name();
    if (name == "extra" || name == "technique") continue;
    if (local_name(*at) != name) fail(*at, "a namespace prefix is not supported");
    if (name == "asset") assets_.push_back(at);
    if (const char* id = at->Attribute("id")) {
      const auto [it, is_new] = ids_.try_emplace({at->Name(), id}, at);
      if (!is_new) it->second = nullptr;
    }
    index(*at);
  }
}

const Element& ColladaDocument::referred(const char* name, const Element& from,
                                         const char* attribute) const {
  const std::string reference = text_attribute(from, attribute);
  if (!reference.starts_with('#')) {
    fail(from, "refers to " + in_quotes(reference) + ", which is not in this file");
  }
  return with_id(name, reference.substr(1), from);
}

const Element& ColladaDocument::with_id(const char* name, const std::string& id,
                                        const Element& from) const {
  budget_.take_steps(steps_for(id));
  const auto it = ids_.find({name, id});
  if (it == ids_.end()) {
    fail(from, "refers to the " + std::string(name) + " " + in_quotes(id) + ", which is not there");
  }
  if (it->second == nullptr) {
    fail(from, "refers to the " + std::string(name) + " " + in_quotes(id) +
                   ", which is there several times");
  }
  return *it->second;
}

std::vector<const Element*> ColladaDocument::children(const Element& parent,
                                                      const char* name) const {
  std::vector<const Element*> result;
  for (auto* at = parent.FirstChild(); at != nullptr; at = at->NextSibling()) {
    budget_.take_steps(1);
    const Element* const element = at->ToElement();
    if (element == nullptr) continue;  // a comment or text
    if (name == nullptr || std::string_view(element->Name()) == name) result.push_back(element);
  }
  return result;
}

const Element& ColladaDocument::child(const Element& parent, const char* name) const {
  const std::vector<const Element*> found = children(parent, name);
  if (found.empty()) fail(parent, "has no <" + std::string(name) + ">");
  if (found.size() > 1) fail(parent, "has more than one <" + std::string(name) + ">");
  return *found.front();
}

std::string ColladaDocument::text_attribute(const Element& element, const char* name) const {
  const char* const text = element.Attribute(name);
  if (text == nullptr) fail(element, "has no attribute " + in_quotes(name));
  budget_.take_steps(steps_for(text));
  return text;
}

std::size_t ColladaDocument::whole_attribute(const Element& element, const char* name,
                                             std::size_t absent) const {
  const char* const text = element.Attribute(name);
  if (text == nullptr) return absent;
  budget_.take_steps(steps_for(text));
  const std::optional<std::int64_t> value = whole_number(text);
  if (!value || *value < 0 || *value > std::numeric_limits<std::uint32_t>::max()) {
    fail(element, "the attribute " + in_quotes(name) + " is not a whole number below 2^32");
  }
  return static_cast<std::size_t>(*value);
}

std::string ColladaDocument::text(const Element& element) const {
  std::string result;
  for (auto* at = element.FirstChild(); at != nullptr; at = at->NextSibling()) {
    budget_.take_steps(1);
    if (at->ToComment() != nullptr) {
      result += ' ';
      continue;
    }
    if (at->ToText() == nullptr) fail(element, "holds something between its numbers");
    budget_.take_steps(steps_for(at->Value()));
    result += at->Value();
  }
  return result;
}

std::vector<std::string_view> ColladaDocument::split(std::string_view text) const {
  std::vector<std::string_view> words = words_of(text);
  budget_.take_steps(words.size());
  return words;
}

std::vector<double> ColladaDocument::numbers(const Element& element) const {
  const std::string content = text(element);
  std::vector<double> result;
  for (const std::string_view word : split(content)) {
    const std::optional<double> value = finite_number(word);
    if (!value) fail(element, in_quotes(word) + " is not a finite number");
    result.push_back(*value);
  }
  return result;
}

std::vector<std::int64_t> ColladaDocument::whole_numbers(const Element& element) const {
  const std::string content = text(element);
  std::vector<std::int64_t> result;
  for (const std::string_view word : split(content)) {
    const std::optional<std::int64_t> value = whole_number(word);
    if (!value) fail(element, in_quotes(word) + " is not a whole number");
    result.push_back(*value);
  }
  return result;
}

std::vector<std::string> ColladaDocument::words(const Element& element) const {
  const std::string content = text(element);
  const std::vector<std::string_view> found = split(content);
  return {found.begin(), found.end()};
}

void ColladaDocument::fail(const Element& element, const std::string& reason) const {
  throw Error(subject_, "line " + std::to_string(element.GetLineNum()) + ": <" +
                            std::string(element.Name()) + "> " + reason);
}

}  // namespace spherule::internal
