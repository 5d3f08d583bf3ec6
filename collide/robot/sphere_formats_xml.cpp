// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/format_text.h"
#include "collide/robot/internal/sphere_documents.h"
#include "spheretree/atomic_file.h"
#include "spheretree/error.h"

#include <map>
#include <memory>
#include <optional>
#include <tinyxml2.h>
#include <vector>

namespace spherule::internal {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

constexpr const char* kApproximation = "link_sphere_approximation";

std::string place_of(const XMLElement& element) {
  return "line " + std::to_string(element.GetLineNum()) + ": <" + element.Name() + ">";
}

// A document whose root is <robot>; refuses others.
std::unique_ptr<XMLDocument> parsed(std::string_view text, const SphereGatherer& gathered) {
  gathered.unless(text.find('\0') == std::string_view::npos, {}, "holds a zero byte");
  auto document = std::make_unique<XMLDocument>();
  if (document->Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    gathered.refuse("line " + std::to_string(document->ErrorLineNum()),
                    std::string("is not XML (") + document->ErrorName() + ")");
  }
  const XMLElement* root = document->RootElement();
  gathered.unless(root && std::string_view(root->Name()) == "robot", {}, "is no <robot>");
  gathered.unless(!root->NextSiblingElement(), {}, "has more than one root element");
  return document;
}

std::optional<std::string> attribute(const XMLElement& element, const char* name,
                                     const SphereGatherer& gathered) {
  std::optional<std::string> value;
  for (const auto* next = element.FirstAttribute(); next; next = next->Next()) {
    if (std::string_view(next->Name()) != name) continue;
    gathered.unless(!value, place_of(element), std::string(name) + " is there twice");
    value = next->Value();
  }
  return value;
}

std::string needed(const XMLElement& element, const char* name, const SphereGatherer& gathered) {
  const auto value = attribute(element, name, gathered);
  gathered.unless(value && !value->empty(), place_of(element), std::string("has no ") + name);
  return *value;
}

Eigen::Vector3d vector(const XMLElement* element, const char* name,
                       const SphereGatherer& gathered) {
  const auto text = element ? attribute(*element, name, gathered) : std::nullopt;
  if (!text) return Eigen::Vector3d::Zero();
  const auto value = vector_of(*text);
  if (!value) gathered.refuse(place_of(*element), std::string(name) + " is not three numbers");
  return *value;
}

// The child of that name, which may be there once.
const XMLElement* only_child(const XMLElement& element, const char* name,
                             const SphereGatherer& gathered) {
  const XMLElement* child = element.FirstChildElement(name);
  if (child && child->NextSiblingElement(name)) {
    gathered.refuse(place_of(element), std::string("holds more than one <") + name + ">");
  }
  return child;
}

// The <sphere> of a <collision>, or nothing if that is of another shape.
std::optional<Sphere> ball_of(const XMLElement& collision, const SphereGatherer& gathered) {
  const XMLElement* geometry = only_child(collision, "geometry", gathered);
  const XMLElement* shape = geometry ? geometry->FirstChildElement() : nullptr;
  gathered.unless(shape != nullptr, place_of(collision), "has no geometry");
  gathered.unless(!shape->NextSiblingElement(), place_of(*geometry), "holds more than one shape");
  if (std::string_view(shape->Name()) != "sphere") return std::nullopt;
  const auto radius = numbers_of(needed(*shape, "radius", gathered));
  gathered.unless(radius && radius->size() == 1, place_of(*shape), "radius is not a number");
  const XMLElement* origin = only_child(collision, "origin", gathered);
  vector(origin, "rpy", gathered);  // a ball looks the same however it is turned
  return Sphere{vector(origin, "xyz", gathered), radius->front()};
}

struct FixedLeaf {
  XMLElement* link = nullptr;
  XMLElement* joint = nullptr;
  std::string parent;
};

bool stands_for_ball(std::string_view name, std::string_view parent) {
  constexpr std::string_view kMiddle = "_sphere";
  if (!name.starts_with(parent)) return false;
  name.remove_prefix(parent.size());
  if (!name.starts_with(kMiddle)) return false;
  name.remove_prefix(kMiddle.size());
  return !name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos;
}

bool is_one_ball(const XMLElement& link) {
  const XMLElement* collision = link.FirstChildElement("collision");
  if (!collision || collision->NextSiblingElement("collision")) return false;
  const XMLElement* geometry = collision->FirstChildElement("geometry");
  if (!geometry || !geometry->FirstChildElement("sphere")) return false;
  for (auto* visual = link.FirstChildElement("visual"); visual;
       visual = visual->NextSiblingElement("visual")) {
    const XMLElement* shape = visual->FirstChildElement("geometry");
    if (shape && shape->FirstChildElement("mesh")) return false;
  }
  return true;
}

// The links that stand for a ball of the link they are fixed to, by name.
std::map<std::string, FixedLeaf> ball_leaves(XMLElement& robot, const SphereGatherer& gathered) {
  std::map<std::string, FixedLeaf> leaves;
  std::set<std::string> parents;
  for (auto* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const XMLElement* parent = only_child(*joint, "parent", gathered);
    const XMLElement* child = only_child(*joint, "child", gathered);
    gathered.unless(parent && child, place_of(*joint), "has no parent or no child");
    const std::string above = needed(*parent, "link", gathered);
    const std::string below = needed(*child, "link", gathered);
    parents.insert(above);
    if (needed(*joint, "type", gathered) != "fixed" || !stands_for_ball(below, above)) continue;
    gathered.unless(leaves.insert({below, {nullptr, joint, above}}).second, place_of(*joint),
                    "is the second joint to \"" + below + "\"");
  }
  std::map<std::string, FixedLeaf> found;
  std::set<std::string> names;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    const std::string name = needed(*link, "name", gathered);
    gathered.unless(names.insert(name).second, place_of(*link), "\"" + name + "\" is there twice");
    const auto leaf = leaves.find(name);
    if (leaf == leaves.end() || parents.contains(name) || !is_one_ball(*link)) continue;
    leaf->second.link = link;
    found.insert(*leaf);
  }
  for (const auto& [name, leaf] : found) {
    gathered.unless(names.contains(leaf.parent), place_of(*leaf.joint),
                    "there is no link \"" + leaf.parent + "\"");
  }
  return found;
}

// --- writing ---

std::string printed(const XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

void remove_children(XMLElement& element, const char* name) {
  while (XMLElement* child = element.FirstChildElement(name)) element.DeleteChild(child);
}

XMLElement& new_collision(XMLDocument& document, const Sphere& ball) {
  XMLElement* collision = document.NewElement("collision");
  XMLElement* origin = collision->InsertNewChildElement("origin");
  origin->SetAttribute("xyz", decimals(ball.center, " ").c_str());
  origin->SetAttribute("rpy", "0 0 0");
  XMLElement* sphere =
      collision->InsertNewChildElement("geometry")->InsertNewChildElement("sphere");
  sphere->SetAttribute("radius", decimal(ball.radius).c_str());
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
  for (const Sphere& ball : spheres) {
    XMLElement& collision = new_collision(document, ball);
    before = before ? link.InsertAfterChild(before, &collision) : link.InsertFirstChild(&collision);
  }
}

// Makes relative file names in `element` and below, given from folder `old_folder`, relative to
// `new_folder`.
void move_files(XMLElement& element, const fs::path& old_folder, const fs::path& new_folder) {
  const std::string_view name = element.Name();
  if (name == "mesh" || name == "texture") {
    const char* file = element.Attribute("filename");
    const fs::path given = file ? file : "";
    if (!given.empty() && given.is_relative() &&
        std::string_view(file).find("://") == std::string_view::npos) {
      const fs::path target = (old_folder / given).lexically_normal();
      const fs::path from_there = target.lexically_relative(new_folder);
      element.SetAttribute("filename", (from_there.empty() ? target : from_there).c_str());
    }
  }
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    move_files(*child, old_folder, new_folder);
  }
}

fs::path folder_of(const fs::path& file) {
  return fs::weakly_canonical(fs::absolute(file).parent_path());
}

}  // namespace

bool is_srdf(std::string_view text) {
  XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return false;
  const XMLElement* root = document.RootElement();
  return root && !root->FirstChildElement("link") && !root->FirstChildElement("joint") &&
         (root->FirstChildElement(kApproximation) || root->FirstChildElement("group") ||
          root->FirstChildElement("disable_collisions"));
}

RobotSpheres read_sphere_urdf(std::string_view text, const std::string& file) {
  SphereGatherer gathered(file);
  const auto document = parsed(text, gathered);
  XMLElement& robot = *document->RootElement();
  gathered.spheres.robot = attribute(robot, "name", gathered).value_or("");
  const auto leaves = ball_leaves(robot, gathered);
  std::map<std::string, std::vector<const FixedLeaf*>> leaves_of;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    const auto leaf = leaves.find(needed(*link, "name", gathered));
    if (leaf != leaves.end()) leaves_of[leaf->second.parent].push_back(&leaf->second);
  }
  std::size_t balls = 0;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    const std::string name = needed(*link, "name", gathered);
    if (leaves.contains(name)) continue;
    gathered.begin_link(name, place_of(*link));
    std::size_t others = 0;
    std::size_t here = 0;
    for (auto* collision = link->FirstChildElement("collision"); collision;
         collision = collision->NextSiblingElement("collision")) {
      const auto ball = ball_of(*collision, gathered);
      if (ball) gathered.add(ball->center, ball->radius, place_of(*collision));
      ++(ball ? here : others);
    }
    for (const FixedLeaf* leaf : leaves_of[name]) {
      const auto ball = ball_of(*leaf->link->FirstChildElement("collision"), gathered);
      const XMLElement* origin = only_child(*leaf->joint, "origin", gathered);
      const Sphere moved =
          moved_ball(*ball, vector(origin, "rpy", gathered), vector(origin, "xyz", gathered));
      gathered.add(moved.center, ball->radius <= 0.0 ? 0.0 : moved.radius, place_of(*leaf->link));
      ++here;
    }
    gathered.spheres.other_shapes += others;
    balls += here;
    if (others > 0 && here == 0) gathered.spheres.links.pop_back();
  }
  gathered.unless(balls > 0 || gathered.spheres.other_shapes == 0, {}, "holds no spheres");
  return std::move(gathered.spheres);
}

std::string sphere_urdf(const RobotSpheres& spheres, const SphereFileContext& context,
                        const fs::path& path) {
  const SphereGatherer gathered(context.urdf.string());
  const auto document = parsed(read_file(context.urdf), gathered);
  XMLElement& robot = *document->RootElement();
  const auto leaves = ball_leaves(robot, gathered);
  std::map<std::string, XMLElement*> links;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    links.insert({needed(*link, "name", gathered), link});
  }
  std::set<std::string> covered;
  for (const LinkSpheres& link : spheres.links) {
    const auto found = links.find(link.link);
    if (found == links.end()) gathered.refuse({}, "has no link \"" + link.link + "\"");
    replace_collisions(*document, *found->second, link.spheres);
    covered.insert(link.link);
  }
  for (const auto& [name, leaf] : leaves) {
    if (!covered.contains(leaf.parent)) continue;
    robot.DeleteChild(leaf.link);
    robot.DeleteChild(leaf.joint);
  }
  const fs::path old_folder = folder_of(context.urdf);
  const fs::path new_folder = folder_of(path);
  if (old_folder != new_folder) move_files(robot, old_folder, new_folder);
  return printed(*document);
}

std::string sphere_srdf(const RobotSpheres& spheres, const SphereFileContext& context) {
  auto document = std::make_unique<XMLDocument>();
  XMLElement* robot = nullptr;
  if (!context.original.empty()) {
    const SphereGatherer gathered(context.original.string());
    document = parsed(read_file(context.original), gathered);
    robot = document->RootElement();
    remove_children(*robot, kApproximation);
  } else {
    document->InsertEndChild(document->NewDeclaration());
    robot = document->NewElement("robot");
    document->InsertEndChild(robot);
    robot->SetAttribute("name", spheres.robot.c_str());
    for (const DisabledPair& pair : spheres.self_collision_ignore) {
      XMLElement* disabled = robot->InsertNewChildElement("disable_collisions");
      disabled->SetAttribute("link1", pair.link_a.c_str());
      disabled->SetAttribute("link2", pair.link_b.c_str());
      if (!pair.reason.empty()) disabled->SetAttribute("reason", pair.reason.c_str());
    }
  }
  for (const LinkSpheres& link : spheres.links) {
    XMLElement* approximation = robot->InsertNewChildElement(kApproximation);
    approximation->SetAttribute("link", link.link.c_str());
    const auto add = [&](const Sphere& ball) {
      XMLElement* sphere = approximation->InsertNewChildElement("sphere");
      sphere->SetAttribute("center", decimals(ball.center, " ").c_str());
      sphere->SetAttribute("radius", decimal(ball.radius).c_str());
    };
    for (const Sphere& ball : link.spheres) add(ball);
    if (link.spheres.empty()) add({});
  }
  return printed(*document);
}

}  // namespace spherule::internal
