// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/xml_file.h"

#include "base/error.h"
#include "base/files.h"
#include "base/parser_fault.h"
#include "base/text.h"
#include "robot/files/format_text.h"

#include <algorithm>
#include <cstddef>
#include <tinyxml2.h>
#include <utility>

namespace spherule::internal {
namespace {

// Why a document is refused whose root is this one; people have robots in other formats, too.
std::string wrong_root(const std::string& root, std::string_view wanted) {
  std::string reason = "its root is no <" + std::string(wanted) + ">";
  if (root == "sdf") return reason + " but <sdf>: an SDF file (Gazebo) has to be made a URDF first";
  if (root == "mujoco") {
    return reason + " but <mujoco>: an MJCF file (MuJoCo) has to be made a URDF first";
  }
  return reason;
}

}  // namespace

std::string_view XmlElement::tag() const {
  return element_->Name();
}

std::string_view XmlElement::text() const {
  const char* const text = element_->GetText();
  return text == nullptr ? std::string_view() : text;
}

std::vector<XmlElement> XmlElement::children(std::string_view tag) const {
  std::vector<XmlElement> result;
  for (const auto* child = element_->FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (tag.empty() || tag == child->Name()) result.emplace_back(*child, *file_);
  }
  return result;
}

std::optional<XmlElement> XmlElement::child(std::string_view tag) const {
  const std::vector<XmlElement> found = children(tag);
  if (found.empty()) return {};
  if (found.size() > 1) found[1].refuse("there is one already");
  return found.front();
}

XmlElement XmlElement::needed_child(std::string_view tag) const {
  const auto found = child(tag);
  if (!found) refuse("it has no <" + std::string(tag) + ">");
  return *found;
}

std::optional<std::string> XmlElement::attribute(std::string_view name) const {
  const char* const value = element_->Attribute(std::string(name).c_str());
  if (value == nullptr) return {};
  if (!is_utf8(value)) refuse(std::string(name) + " is no text in UTF-8");
  return value;
}

std::string XmlElement::needed(std::string_view name) const {
  const auto value = attribute(name);
  if (!value || value->empty()) refuse("it has no " + std::string(name));
  return *value;
}

std::optional<std::vector<double>> XmlElement::numbers(std::string_view name) const {
  const auto text = attribute(name);
  if (!text) return {};
  std::vector<double> result;
  for (const std::string_view word : words_of(*text)) {
    const auto number = finite_number(word);
    if (!number) refuse(std::string(name) + ": " + in_quotes(word) + " is no finite number");
    result.push_back(*number);
  }
  return result;
}

std::optional<std::vector<double>> XmlElement::numbers(std::string_view name,
                                                       std::size_t count) const {
  auto result = numbers(name);
  if (result && result->size() != count) {
    refuse(std::string(name) + " has " + std::to_string(result->size()) + " numbers where " +
           std::to_string(count) + " belong");
  }
  return result;
}

double XmlElement::number(std::string_view name, double otherwise) const {
  const auto result = numbers(name, 1);
  return result ? result->front() : otherwise;
}

Eigen::Vector3d XmlElement::vector(std::string_view name, const Eigen::Vector3d& otherwise) const {
  const auto result = numbers(name, 3);
  return result ? Eigen::Vector3d(result->data()) : otherwise;
}

std::vector<double> XmlElement::needed_numbers(std::string_view name) const {
  auto result = numbers(name);
  if (!result || result->empty()) refuse("it has no " + std::string(name));
  return *std::move(result);
}

double XmlElement::needed_number(std::string_view name) const {
  const auto result = numbers(name, 1);
  if (!result) refuse("it has no " + std::string(name));
  return result->front();
}

Eigen::Vector3d XmlElement::needed_vector(std::string_view name) const {
  const auto result = numbers(name, 3);
  if (!result) refuse("it has no " + std::string(name));
  return Eigen::Vector3d(result->data());
}

void XmlElement::require_attributes(std::initializer_list<std::string_view> known) const {
  for (const auto* a = element_->FirstAttribute(); a != nullptr; a = a->Next()) {
    if (std::find(known.begin(), known.end(), a->Name()) == known.end()) {
      refuse("it has an attribute " + in_quotes(a->Name()) + " of unknown meaning");
    }
  }
}

std::string XmlElement::place_in_file() const {
  std::string place = "line " + std::to_string(element_->GetLineNum()) + ": ";
  // The nearest element with a name, below the root.
  for (const tinyxml2::XMLNode* node = element_; node->Parent() != nullptr; node = node->Parent()) {
    const tinyxml2::XMLElement* const around = node->ToElement();
    const bool is_root = node->Parent()->ToDocument() != nullptr;
    const char* const name = around && !is_root ? around->Attribute("name") : nullptr;
    if (name == nullptr || *name == '\0') continue;
    place += std::string(around->Name()) + " " + in_quotes(name) + ": ";
    break;
  }
  return place + "<" + element_->Name() + ">: ";
}

std::string XmlElement::place() const {
  return *file_ + ": " + place_in_file();
}

void XmlElement::refuse(const std::string& reason) const {
  throw Error(*file_, place_in_file() + reason);
}

XmlFile::XmlFile(const std::filesystem::path& path, std::string_view tag)
    : XmlFile(path.string(), read_file(path), tag) {}

XmlFile::XmlFile(std::string name, const std::string& text, std::string_view tag)
    : name_(std::move(name)), document_(std::make_unique<tinyxml2::XMLDocument>()) {
  if (text.find('\0') != std::string::npos) throw Error(name_, "it holds a zero byte");
  const std::string large = fault_of_large_tag(text);
  if (!large.empty()) throw Error(name_, large);
  if (document_->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(name_, xml_fault(document_->ErrorName(), document_->ErrorLineNum()));
  }
  const tinyxml2::XMLElement* const root = document_->RootElement();
  if (root == nullptr || tag != root->Name()) {
    throw Error(name_, wrong_root(root == nullptr ? "" : root->Name(), tag));
  }
  if (root->NextSiblingElement() != nullptr) throw Error(name_, "it has more than one root");
  for (const tinyxml2::XMLNode* node = document_->FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText() == nullptr) continue;
    throw Error(
        name_, "line " + std::to_string(node->GetLineNum()) + ": text outside of the root element");
  }
}

XmlFile::~XmlFile() = default;

XmlElement XmlFile::root() const {
  return {*document_->RootElement(), name_};
}

std::string XmlFile::printed() const {
  tinyxml2::XMLPrinter printer;
  document_->Print(&printer);
  return printer.CStr();
}

}  // namespace spherule::internal
