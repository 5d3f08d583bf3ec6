// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// XML files, read strictly: what is requested is there and is what it has to be, or an Error names
// the file, the line and the element.

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace spherule::internal {

// An element of an XmlFile, which must outlive it.
class XmlElement {
 public:
  XmlElement(const tinyxml2::XMLElement& element, const std::string& file)
      : element_(&element), file_(&file) {}

  std::string_view tag() const;
  std::string_view text() const;  // up to the first element in it
  // Of this tag, or all; in the order of the file.
  std::vector<XmlElement> children(std::string_view tag = {}) const;
  // The only child of this tag, which may be missing, or is needed.
  std::optional<XmlElement> child(std::string_view tag) const;
  XmlElement needed_child(std::string_view tag) const;

  // An attribute that may be missing, or is needed and not empty: text in UTF-8.
  std::optional<std::string> attribute(std::string_view name) const;
  std::string needed(std::string_view name) const;
  // Finite numbers between white space: any number of them, or as many as requested. Nothing where
  // the attribute is missing, unless it is needed.
  std::optional<std::vector<double>> numbers(std::string_view name) const;
  std::optional<std::vector<double>> numbers(std::string_view name, std::size_t count) const;
  // One or three finite numbers; `otherwise` where the attribute is missing.
  double number(std::string_view name, double otherwise) const;
  Eigen::Vector3d vector(std::string_view name, const Eigen::Vector3d& otherwise) const;
  std::vector<double> needed_numbers(std::string_view name) const;
  double needed_number(std::string_view name) const;
  Eigen::Vector3d needed_vector(std::string_view name) const;
  // Refuses an attribute that is not one of these.
  void require_attributes(std::initializer_list<std::string_view> known) const;

  // "FILE: line 3: joint 'elbow': <limit>: ", for warnings.
  std::string place() const;

  // Throws Error: the line, the element and what has a name around it, and the reason.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  std::string place_in_file() const;

  const tinyxml2::XMLElement* element_;
  const std::string* file_;
};

class XmlFile {
 public:
  // Throws Error for a file that cannot be read, is no XML, or has another root than `tag`
  // or text outside of it.
  XmlFile(const std::filesystem::path& path, std::string_view tag);
  // Of the text of a file of this name.
  XmlFile(std::string name, const std::string& text, std::string_view tag);
  ~XmlFile();

  XmlElement root() const;
  // To be changed, and the text of what it has become; comments stay.
  tinyxml2::XMLDocument& document() { return *document_; }
  std::string printed() const;

 private:
  std::string name_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
};

}  // namespace spherule::internal
