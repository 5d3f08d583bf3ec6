// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_documents.h"
#include "robot/formats/sphere_leaves.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

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

}  // namespace

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
    if (!links.contains(parent)) joint.refuse("there is no link \"" + parent + "\"");
    leaves.insert({child, {link->second, joint, parent}});
  }
  std::erase_if(leaves, [&](const auto& leaf) { return parents.contains(leaf.first); });
  return leaves;
}

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
         (has("link_sphere_approximation") || has("group") || has("disable_collisions"));
}

}  // namespace spherule::internal
