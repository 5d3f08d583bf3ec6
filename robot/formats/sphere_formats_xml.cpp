// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "robot/files/format_text.h"
#include "robot/files/mesh_path.h"
#include "robot/files/xml_file.h"
#include "robot/formats/sphere_documents.h"
#include "robot/formats/sphere_leaves.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <vector>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

// The text of a file that has been read as XML before.
std::unique_ptr<XMLDocument> parsed(const std::string& text, const fs::path& path) {
  auto document = std::make_unique<XMLDocument>();
  if (document->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(path.string(), "is not XML");
  }
  return document;
}

// Takes out the links that stand for spheres of links in `covered`, and their joints.
void remove_leaves(XMLElement& robot, const std::map<std::string, SphereLeaf>& leaves,
                   const std::set<std::string>& covered) {
  const auto goes = [&](const char* name) {
    const auto leaf = leaves.find(name);
    return leaf != leaves.end() && covered.contains(leaf->second.parent);
  };
  XMLElement* next = nullptr;
  for (XMLElement* part = robot.FirstChildElement(); part; part = next) {
    next = part->NextSiblingElement();
    const std::string_view tag = part->Name();
    const XMLElement* child = tag == "joint" ? part->FirstChildElement("child") : nullptr;
    const bool link_goes = tag == "link" && goes(part->Attribute("name"));
    if (link_goes || (child && goes(child->Attribute("link")))) robot.DeleteChild(part);
  }
}

std::string printed(const XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

void remove_children(XMLElement& element, const char* name) {
  while (XMLElement* child = element.FirstChildElement(name)) element.DeleteChild(child);
}

XMLElement& new_collision(XMLDocument& document, const Sphere& sphere) {
  XMLElement* collision = document.NewElement("collision");
  XMLElement* origin = collision->InsertNewChildElement("origin");
  origin->SetAttribute("xyz", decimals(sphere.center, " ").c_str());
  origin->SetAttribute("rpy", "0 0 0");
  XMLElement* shape = collision->InsertNewChildElement("geometry")->InsertNewChildElement("sphere");
  shape->SetAttribute("radius", decimal(sphere.radius).c_str());
  return *collision;
}

// Where the old ones were, or at the end.
void replace_collisions(XMLDocument& document, XMLElement& link,
                        const std::vector<Sphere>& spheres) {
  tinyxml2::XMLNode* before = nullptr;
  if (XMLElement* first = link.FirstChildElement("collision")) {
    before = first->PreviousSibling();
  } else {
    before = link.LastChild();
  }
  remove_children(link, "collision");
  for (const Sphere& sphere : spheres) {
    XMLElement& collision = new_collision(document, sphere);
    before = before ? link.InsertAfterChild(before, &collision) : link.InsertFirstChild(&collision);
  }
}

// Makes relative file names in `element` and below, given from folder `old_folder`, relative to
// `new_folder`.
void move_files(XMLElement& element, const fs::path& old_folder, const fs::path& new_folder) {
  const std::string_view name = element.Name();
  if (name == "mesh" || name == "texture") {
    const char* file = element.Attribute("filename");
    const MeshName given = mesh_name(file ? file : "");
    const bool is_path = given.kind == MeshName::Kind::kPath || given.kind == MeshName::Kind::kFile;
    if (is_path && !given.rest.empty() && fs::path(given.rest).is_relative()) {
      const fs::path target = (old_folder / given.rest).lexically_normal();
      const fs::path from_there = target.lexically_relative(new_folder);
      const fs::path& moved = from_there.empty() ? target : from_there;
      element.SetAttribute("filename", (std::string(given.scheme) + moved.string()).c_str());
    }
  }
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    move_files(*child, old_folder, new_folder);
  }
}

fs::path folder_of(const fs::path& file) {
  return fs::weakly_canonical(absolute_path(file).parent_path());
}

}  // namespace

std::string sphere_urdf(const RobotSpheres& spheres, const SphereFileContext& context,
                        const fs::path& path) {
  const std::string text = urdf_text(context.urdf);
  const XmlFile file(context.urdf.string(), text, "robot");
  const auto leaves = sphere_leaves(file.root());
  const auto document = parsed(text, context.urdf);
  XMLElement& robot = *document->RootElement();
  std::map<std::string, XMLElement*> links;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    links.insert({link->Attribute("name"), link});
  }
  std::set<std::string> covered;
  for (const LinkSpheres& link : spheres.links) {
    const auto found = links.find(link.link);
    if (found == links.end()) {
      throw Error(context.urdf.string(), "has no link \"" + link.link + "\"");
    }
    replace_collisions(*document, *found->second, link.spheres);
    covered.insert(link.link);
  }
  remove_leaves(robot, leaves, covered);
  const fs::path old_folder = folder_of(context.urdf);
  const fs::path new_folder = folder_of(path);
  if (old_folder != new_folder) move_files(robot, old_folder, new_folder);
  return printed(*document);
}

std::string sphere_srdf(const RobotSpheres& spheres, const SphereFileContext& context) {
  if (!context.original.empty()) return kept_srdf(spheres, context.original);
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<robot name=\"" + xml_escaped(spheres.robot) +
         "\">\n" + srdf_pairs(spheres.self_collision_ignore, "    ") +
         srdf_spheres(spheres.links, "    ") + "</robot>\n";
}

}  // namespace spherule::internal
