// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/link_parts.h"

#include "robot/cover/internal/equal_links.h"

#include <algorithm>
#include <map>
#include <set>
#include <variant>

namespace spherule::internal {
namespace {

// Chord error of the meshes around curved primitives.
constexpr double kChordError = LinkMeshOptions{}.chord_error;

bool has_curved_shapes(const LinkDescription& link, LinkGeometry geometry) {
  return std::ranges::any_of(link_shapes(link, geometry), [](const LinkShape& shape) {
    const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
    return primitive != nullptr && !std::holds_alternative<Box>(*primitive);
  });
}

// `first` are the first links of the same shapes.
void find_equal(std::vector<LinkParts>& parts, const std::vector<std::size_t>& first) {
  std::map<std::size_t, std::vector<std::size_t>> different;  // parts by their first link
  for (LinkParts& part : parts) {
    std::vector<std::size_t>& known = different[first[part.index]];
    const auto equal = std::ranges::find_if(
        known, [&](std::size_t other) { return parts[other].spheres == part.spheres; });
    if (equal != known.end()) {
      part.first_equal = *equal;
    } else {
      known.push_back(part.index);
    }
  }
}

}  // namespace

std::vector<LinkParts> parts_of(const RobotDescription& robot, std::span<const LinkSpheres> spheres,
                                LinkGeometry geometry, std::vector<std::string>* unknown) {
  std::vector<LinkParts> parts;
  std::map<std::string, std::size_t> index;
  for (const LinkDescription& link : robot.links) {
    index[link.name] = parts.size();
    parts.push_back({link.name,
                     parts.size(),
                     parts.size(),
                     link_mesh(link, {.geometry = geometry, .chord_error = kChordError}),
                     has_curved_shapes(link, geometry) ? kChordError : 0.0,
                     {}});
  }
  if (std::none_of(parts.begin(), parts.end(), [](const auto& part) { return part.mesh; })) {
    throw Error("robot \"" + robot.name + "\"", geometry == LinkGeometry::kVisual
                                                    ? "has no visual geometry"
                                                    : "has no collision geometry");
  }
  std::set<std::string> seen;
  for (const LinkSpheres& link : spheres) {
    const std::string subject = "link \"" + link.link + "\"";
    if (!seen.insert(link.link).second) throw Error(subject, "has spheres twice");
    if (!std::all_of(link.spheres.begin(), link.spheres.end(), is_usable)) {
      throw Error(subject, "has a sphere that is not usable");
    }
    const auto found = index.find(link.link);
    if (found != index.end()) {
      parts[found->second].spheres = link.spheres;
    } else if (unknown && !link.spheres.empty()) {
      unknown->push_back(link.link);
    }
  }
  find_equal(parts, first_equal_links(robot, geometry));
  return parts;
}

}  // namespace spherule::internal
