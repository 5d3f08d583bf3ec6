// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/internal/urdf_text.h"

#include <array>
#include <charconv>
#include <map>
#include <set>
#include <string_view>

namespace spherule::internal {
namespace {

// Shortest of the texts that are read as this number again.
std::string text_of(double number) {
  std::array<char, 32> buffer;
  const auto written = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return {buffer.data(), written.ptr};
}

class Writer {
 public:
  const std::string& text() const { return text_; }
  std::size_t shapes() const { return shapes_; }

  void link(const XmlElement& link) {
    open("link", link.needed("name"));
    for (const XmlElement& visual : link.children("visual")) shape(visual);
    for (const XmlElement& collision : link.children("collision")) shape(collision);
    text_ += "</link>\n";
  }

  void joint(const XmlElement& joint) {
    const std::string type = joint.needed("type");
    open("joint", joint.needed("name"), type);
    for (const std::string_view end : {"parent", "child"}) {
      const XmlElement element = joint.needed_child(end);
      begin(end);
      attribute("link", element.needed("link"));
      text_ += "/>";
    }
    origin(joint);
    if (const auto axis = joint.child("axis")) {
      axis->require_attributes({"xyz"});
      begin("axis");
      vector(*axis, "xyz");
      text_ += "/>";
    }
    limit(joint, type);
    mimic(joint);
    text_ += "</joint>\n";
  }

 private:
  void begin(std::string_view tag) { text_.append("<").append(tag); }

  void attribute(std::string_view name, std::string_view value) {
    text_.append(" ").append(name).append("=\"").append(xml_escaped(value)).append("\"");
  }

  void open(std::string_view tag, std::string_view name, std::string_view type = {}) {
    begin(tag);
    attribute("name", name);
    if (!type.empty()) attribute("type", type);
    text_ += ">";
  }

  // Where the element has it.
  void numbers(const XmlElement& element, std::string_view name, std::size_t count) {
    const auto values = element.numbers(name, count);
    if (!values) return;
    std::string text;
    for (const double value : *values) text.append(text.empty() ? "" : " ").append(text_of(value));
    attribute(name, text);
  }

  void vector(const XmlElement& element, std::string_view name) {
    element.needed_vector(name);
    numbers(element, name, 3);
  }

  void number(const XmlElement& element, std::string_view name) {
    element.needed_number(name);
    numbers(element, name, 1);
  }

  void origin(const XmlElement& around) {
    const auto origin = around.child("origin");
    if (!origin) return;
    origin->require_attributes({"xyz", "rpy"});
    begin("origin");
    numbers(*origin, "xyz", 3);
    numbers(*origin, "rpy", 3);
    text_ += "/>";
  }

  // urdfdom asks for an effort and a velocity, which are nothing to geometry.
  void limit(const XmlElement& joint, std::string_view type) {
    const auto limit = joint.child("limit");
    if (type != "revolute" && type != "prismatic") return;
    if (!limit) joint.refuse("it has no <limit>");
    begin("limit");
    attribute("effort", "0");
    attribute("velocity", "0");
    numbers(*limit, "lower", 1);
    numbers(*limit, "upper", 1);
    text_ += "/>";
  }

  void mimic(const XmlElement& joint) {
    const auto mimic = joint.child("mimic");
    if (!mimic) return;
    mimic->require_attributes({"joint", "multiplier", "offset"});
    begin("mimic");
    attribute("joint", mimic->needed("joint"));
    numbers(*mimic, "multiplier", 1);
    numbers(*mimic, "offset", 1);
    text_ += "/>";
  }

  void shape(const XmlElement& element) {
    const XmlElement geometry = element.needed_child("geometry");
    const std::vector<XmlElement> solids = geometry.children();
    if (solids.size() != 1) geometry.refuse("it has not one shape");
    ++shapes_;
    open(element.tag(), element.attribute("name").value_or(""));
    origin(element);
    text_ += "<geometry>";
    solid(solids.front());
    text_.append("</geometry></").append(element.tag()).append(">");
  }

  void solid(const XmlElement& solid) {
    begin(solid.tag());
    if (solid.tag() == "box") {
      solid.require_attributes({"size"});
      vector(solid, "size");
    } else if (solid.tag() == "sphere") {
      solid.require_attributes({"radius"});
      number(solid, "radius");
    } else if (solid.tag() == "cylinder") {
      solid.require_attributes({"radius", "length"});
      number(solid, "radius");
      number(solid, "length");
    } else if (solid.tag() == "mesh") {
      attribute("filename", solid.needed("filename"));
      numbers(solid, "scale", 3);
    } else {
      solid.refuse("it is none of the shapes that can be read: box, cylinder, mesh, sphere");
    }
    text_ += "/>";
  }

  std::string text_;
  std::size_t shapes_ = 0;
};

// Of what is in such an element nothing is known.
void refuse_xacro(const XmlElement& element) {
  if (element.tag().starts_with("xacro:")) {
    element.refuse("this is a file for xacro, which makes a URDF of it");
  }
  for (const XmlElement& child : element.children()) refuse_xacro(child);
}

std::string link_at(const XmlElement& joint, std::string_view end) {
  return joint.needed_child(end).needed("link");
}

// Refuses links below two joints, and links above themselves.
void check_tree(const std::vector<XmlElement>& joints) {
  std::map<std::string, const XmlElement*> above;
  for (const XmlElement& joint : joints) {
    const std::string link = link_at(joint, "child");
    const auto [other, is_first] = above.emplace(link, &joint);
    if (!is_first) {
      joint.refuse("link '" + link + "' is below two joints, this one and '" +
                   other->second->needed("name") + "'");
    }
  }
  std::set<std::string> below_root;
  for (const auto& [link, joint] : above) {
    std::set<std::string> way;
    for (std::string at = link; above.contains(at) && !below_root.contains(at);
         at = link_at(*above.at(at), "parent")) {
      if (!way.insert(at).second) above.at(at)->refuse("link '" + at + "' is above itself");
    }
    below_root.merge(way);
  }
}

}  // namespace

UrdfText plain_urdf(const XmlElement& robot) {
  const auto version = robot.attribute("version");
  if (version && *version != "1.0") robot.refuse("only version 1.0 of URDF can be read");
  refuse_xacro(robot);
  UrdfText result;
  Writer writer;
  for (const XmlElement& link : robot.children("link")) writer.link(link);
  const std::vector<XmlElement> joints = robot.children("joint");
  check_tree(joints);
  for (const XmlElement& joint : joints) {
    result.joints.push_back(joint.needed("name"));
    writer.joint(joint);
  }
  result.text =
      "<robot name=\"" + xml_escaped(robot.needed("name")) + "\">\n" + writer.text() + "</robot>\n";
  result.shapes = writer.shapes();
  return result;
}

}  // namespace spherule::internal
