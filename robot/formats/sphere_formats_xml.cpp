// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/files.h"
#include "robot/files/format_text.h"
#include "robot/files/robot_description.h"
#include "robot/files/urdf_files.h"
#include "robot/files/xml_file.h"
#include "robot/formats/sphere_documents.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tinyxml2.h>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

// A link that stands for a sphere of the link that it is fixed to (sphere_formats.h).
struct SphereLeaf {
  XmlElement link;
  XmlElement joint;
  std::string parent;
};

// Of an element that may be missing, as zeros.
Vector3d vector(const std::optional<XmlElement>& element, const char* name) {
  return element ? element->vector(name, Vector3d::Zero()) : Vector3d::Zero();
}

// The <sphere> of a <collision>, or nothing if that is of another shape.
std::optional<Sphere> sphere_of(const XmlElement& collision) {
  const auto shapes = collision.needed_child("geometry").children();
  if (shapes.size() != 1) collision.refuse("its geometry is not one shape");
  if (shapes.front().tag() != "sphere") return std::nullopt;
  const auto origin = collision.child("origin");
  vector(origin, "rpy");  // a sphere looks the same however it is turned
  return Sphere{vector(origin, "xyz"), shapes.front().needed_number("radius")};
}

bool is_named_after(std::string_view name, std::string_view parent) {
  constexpr std::string_view kMiddle = "_sphere";
  if (!name.starts_with(parent)) return false;
  name.remove_prefix(parent.size());
  if (!name.starts_with(kMiddle)) return false;
  name.remove_prefix(kMiddle.size());
  return !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_one_sphere(const XmlElement& link) {
  const auto collisions = link.children("collision");
  if (collisions.size() != 1) return false;
  const auto geometry = collisions.front().child("geometry");
  if (!geometry || !geometry->child("sphere")) return false;
  const auto visuals = link.children("visual");
  return std::none_of(visuals.begin(), visuals.end(), [](const XmlElement& visual) {
    const auto shape = visual.child("geometry");
    return shape && shape->child("mesh");
  });
}

// Where in the file an element is; refuse() of it says more.
std::string place_of(const std::string& link) {
  return "link \"" + link + "\"";
}

// All of a URDF's <robot>, by name. Throws Error for names that are missing or there twice.
std::map<std::string, SphereLeaf> sphere_leaves(const XmlElement& robot) {
  std::map<std::string, XmlElement> links;
  for (const XmlElement& link : robot.children("link")) {
    if (!links.insert({link.needed("name"), link}).second) link.refuse("it is there twice");
  }
  std::map<std::string, SphereLeaf> leaves;
  std::set<std::string> parents;
  for (const XmlElement& joint : robot.children("joint")) {
    const std::string parent = joint.needed_child("parent").needed("link");
    const std::string child = joint.needed_child("child").needed("link");
    parents.insert(parent);
    const auto link = links.find(child);
    if (joint.needed("type") != "fixed" || !is_named_after(child, parent) || link == links.end()) {
      continue;
    }
    if (leaves.contains(child)) joint.refuse("it is the second joint to \"" + child + "\"");
    if (!is_one_sphere(link->second)) continue;
    const auto origin = joint.child("origin");
    if (origin && origin->attribute("quat_xyzw")) continue;  // a link as any other
    if (!links.contains(parent)) joint.refuse("there is no link \"" + parent + "\"");
    leaves.insert({child, {link->second, joint, parent}});
  }
  std::erase_if(leaves, [&](const auto& leaf) { return parents.contains(leaf.first); });
  return leaves;
}

// Takes out the links that stand for spheres of links in `covered`, and their joints; not those
// that have spheres of their own there.
void remove_leaves(XMLElement& robot, const std::map<std::string, SphereLeaf>& leaves,
                   const std::set<std::string>& covered) {
  const auto goes = [&](const char* name) {
    const auto leaf = leaves.find(name);
    return leaf != leaves.end() && covered.contains(leaf->second.parent) &&
           !covered.contains(leaf->first);
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

// Puts new elements in the place of all children of that name, or at the end.
void replace_children(XMLElement& parent, const char* name,
                      const std::vector<XMLElement*>& elements) {
  const XMLElement* const first = parent.FirstChildElement(name);
  tinyxml2::XMLNode* before = parent.LastChild();
  if (first != nullptr) before = const_cast<tinyxml2::XMLNode*>(first->PreviousSibling());
  while (XMLElement* child = parent.FirstChildElement(name)) parent.DeleteChild(child);
  for (XMLElement* element : elements) {
    before = before ? parent.InsertAfterChild(before, element) : parent.InsertFirstChild(element);
  }
}

XMLElement* new_collision(XMLDocument& document, const Sphere& sphere) {
  XMLElement* collision = document.NewElement("collision");
  XMLElement* origin = collision->InsertNewChildElement("origin");
  origin->SetAttribute("xyz", decimals(sphere.center, " ").c_str());
  origin->SetAttribute("rpy", "0 0 0");
  XMLElement* shape = collision->InsertNewChildElement("geometry")->InsertNewChildElement("sphere");
  shape->SetAttribute("radius", decimal(sphere.radius).c_str());
  return collision;
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

XMLElement* new_pair(XMLDocument& document, const DisabledPair& pair) {
  XMLElement* element = document.NewElement("disable_collisions");
  element->SetAttribute("link1", pair.link_a.c_str());
  element->SetAttribute("link2", pair.link_b.c_str());
  if (!pair.reason.empty()) element->SetAttribute("reason", pair.reason.c_str());
  return element;
}

// A link without spheres has one of radius 0.
XMLElement* new_approximation(XMLDocument& document, const LinkSpheres& link) {
  XMLElement* element = document.NewElement("link_sphere_approximation");
  element->SetAttribute("link", link.link.c_str());
  const auto put = [&](const Sphere& sphere) {
    XMLElement* child = element->InsertNewChildElement("sphere");
    child->SetAttribute("center", decimals(sphere.center, " ").c_str());
    child->SetAttribute("radius", decimal(sphere.radius).c_str());
  };
  for (const Sphere& sphere : link.spheres) put(sphere);
  if (link.spheres.empty()) put({});
  return element;
}

using Names = std::pair<std::string, std::string>;

// Pairs of which the file says that they are not tested, or that they are.
std::set<Names> decided_pairs(const XmlElement& robot) {
  std::set<Names> pairs;
  for (const char* const tag : {"disable_collisions", "enable_collisions"}) {
    for (const XmlElement& element : robot.children(tag)) {
      pairs.insert(std::minmax(element.needed("link1"), element.needed("link2")));
    }
  }
  return pairs;
}

}  // namespace

RobotSpheres read_sphere_urdf(const std::filesystem::path& path) {
  const XmlFile file(path, "robot");
  const XmlElement robot = file.root();
  SphereGatherer gathered(path.string());
  gathered.spheres.robot = robot.attribute("name").value_or("");
  const auto leaves = sphere_leaves(robot);
  std::map<std::string, std::vector<const SphereLeaf*>> leaves_of;
  for (const XmlElement& link : robot.children("link")) {
    const auto leaf = leaves.find(link.needed("name"));
    if (leaf != leaves.end()) leaves_of[leaf->second.parent].push_back(&leaf->second);
  }
  std::size_t spheres = 0;
  for (const XmlElement& link : robot.children("link")) {
    const std::string name = link.needed("name");
    if (leaves.contains(name)) continue;
    gathered.begin_link(name, place_of(name));
    std::size_t others = 0;
    std::size_t here = 0;
    for (const XmlElement& collision : link.children("collision")) {
      const auto sphere = sphere_of(collision);
      if (sphere) gathered.add(sphere->center, sphere->radius, place_of(name));
      ++(sphere ? here : others);
    }
    for (const SphereLeaf* leaf : leaves_of[name]) {
      const auto sphere = sphere_of(leaf->link.needed_child("collision"));
      const auto origin = leaf->joint.child("origin");
      const Sphere moved = moved_sphere(*sphere, vector(origin, "rpy"), vector(origin, "xyz"));
      gathered.add(moved.center, sphere->radius <= 0.0 ? 0.0 : moved.radius, place_of(name));
      ++here;
    }
    gathered.spheres.other_shapes += others;
    spheres += here;
    if (others > 0 && here == 0) gathered.spheres.links.pop_back();
  }
  gathered.unless(spheres > 0 || gathered.spheres.other_shapes == 0, {}, "holds no spheres");
  return std::move(gathered.spheres);
}

bool is_srdf(const std::filesystem::path& path) {
  const XmlFile file(path, "robot");
  const XmlElement robot = file.root();
  const auto has = [&](const char* tag) { return !robot.children(tag).empty(); };
  return !has("link") && !has("joint") &&
         (has("link_sphere_approximation") || has("group") || has("disable_collisions") ||
          has("disable_default_collisions") || has("enable_collisions"));
}

// A radius of zero says that a link has no spheres.
RobotSpheres read_sphere_srdf(const std::filesystem::path& path) {
  const SemanticDescription semantics = read_srdf(path);
  SphereGatherer gathered(path.string());
  gathered.unless(!semantics.sphere_approximations.empty(), {}, "has no link_sphere_approximation");
  for (const LinkSpheres& link : semantics.sphere_approximations) {
    gathered.begin_link(link.link, {});
    for (const Sphere& sphere : link.spheres) {
      gathered.add(sphere.center, sphere.radius, "link \"" + link.link + "\"");
    }
  }
  gathered.spheres.robot = semantics.robot_name;
  std::vector<std::string> links;
  for (const LinkSpheres& link : semantics.sphere_approximations) {
    if (!link.spheres.empty()) links.push_back(link.link);
  }
  gathered.spheres.self_collision_ignore = disabled_among(semantics, links);
  return std::move(gathered.spheres);
}

std::string sphere_urdf(const RobotSpheres& spheres, const SphereFileContext& context,
                        const fs::path& path) {
  XmlFile file(context.urdf.string(), urdf_text(context.urdf), "robot");
  const auto leaves = sphere_leaves(file.root());
  XMLDocument& document = file.document();
  XMLElement& robot = *document.RootElement();
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
    std::vector<XMLElement*> collisions;
    for (const Sphere& sphere : link.spheres) {
      collisions.push_back(new_collision(document, sphere));
    }
    replace_children(*found->second, "collision", collisions);
    covered.insert(link.link);
  }
  remove_leaves(robot, leaves, covered);
  const fs::path old_folder = folder_of(context.urdf);
  const fs::path new_folder = folder_of(path);
  if (old_folder != new_folder) move_files(robot, old_folder, new_folder);
  return file.printed();
}

std::string sphere_srdf(const RobotSpheres& spheres, const SphereFileContext& context) {
  const bool is_new = context.original.empty();
  XmlFile file(
      context.original.string(),
      is_new ? "<?xml version=\"1.0\" encoding=\"UTF-8\"?><robot/>" : urdf_text(context.original),
      "robot");
  std::set<Names> decided = decided_pairs(file.root());
  XMLDocument& document = file.document();
  XMLElement& robot = *document.RootElement();
  if (is_new) robot.SetAttribute("name", spheres.robot.c_str());
  XMLElement* last = robot.LastChildElement("disable_collisions");
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    if (pair.reason == kDisabledByDefault) continue;  // the file says so, link by link
    if (!decided.insert(std::minmax(pair.link_a, pair.link_b)).second) continue;
    XMLElement* added = new_pair(document, pair);
    if (last != nullptr) {
      robot.InsertAfterChild(last, added);
    } else {
      robot.InsertEndChild(added);
    }
    last = added;
  }
  std::vector<XMLElement*> approximations;
  for (const LinkSpheres& link : spheres.links) {
    approximations.push_back(new_approximation(document, link));
  }
  replace_children(robot, "link_sphere_approximation", approximations);
  return file.printed();
}

}  // namespace spherule::internal
