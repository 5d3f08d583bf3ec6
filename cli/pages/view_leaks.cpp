// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_leaks.h"

#include "cli/pages/view_files.h"

#include <memory>
#include <span>
#include <utility>
#include <variant>

namespace spherule {
namespace {

// Of a part that is no set of spheres, none.
std::span<const Sphere> spheres_in(const ViewPart& part) {
  if (const auto* set = std::get_if<std::vector<Sphere>>(&part.content)) return *set;
  if (const auto* tree = std::get_if<SphereTree>(&part.content)) return tree->spheres();
  return {};
}

std::shared_ptr<const LeakSurface> surface_of_leaks(const TriangleMesh& mesh,
                                                    std::span<const Sphere> spheres) {
  return std::make_shared<const LeakSurface>(leak_surface(mesh, spheres));
}

bool is_sphere_set(const ViewItem& item) {
  if (item.external || !item.shown) return false;
  for (const ViewPart& part : item.parts) {
    if (!spheres_in(part).empty()) return true;
  }
  return false;
}

// The meshes that are shown at first, of a link.
std::vector<const TriangleMesh*> meshes_of(const std::vector<ViewItem>& items, int link) {
  std::vector<const TriangleMesh*> meshes;
  for (const ViewItem& item : items) {
    if (!item.shown) continue;
    for (const ViewPart& part : item.parts) {
      const auto* mesh = std::get_if<TriangleMesh>(&part.content);
      if (mesh != nullptr && part.link == link) meshes.push_back(mesh);
    }
  }
  return meshes;
}

bool is_of_certificates(const ViewItem& item) {
  return item.shown && item.of.empty() && !item.parts.empty() &&
         std::holds_alternative<ViewLeaks>(item.parts.front().content);
}

// Of a link that leaks. Of several meshes of it there is no telling which one it is that leaks.
void add_surface(const std::vector<ViewItem>& items, const ViewItem& spheres, ViewPart& part) {
  auto& leaks = std::get<ViewLeaks>(part.content);
  const std::vector<const TriangleMesh*> meshes = meshes_of(items, part.link);
  if (leaks.points.empty() || meshes.size() != 1) return;
  for (const ViewPart& of_set : spheres.parts) {
    if (of_set.link == part.link)
      leaks.surface = surface_of_leaks(*meshes.front(), spheres_in(of_set));
  }
}

}  // namespace

std::vector<ViewItem> sampled_leaks(const std::vector<ViewItem>& items) {
  std::vector<ViewItem> found;
  for (const ViewItem& item : items) {
    if (!is_sphere_set(item)) continue;
    ViewItem leaks{.name = leaks_name(item.name), .parts = {}, .facts = "found by samples"};
    leaks.of = item.name;
    for (const ViewPart& part : item.parts) {
      const std::span<const Sphere> spheres = spheres_in(part);
      for (const TriangleMesh* mesh : meshes_of(items, part.link)) {
        ViewPart& found_here = leaks.parts.emplace_back();
        found_here.content =
            ViewLeaks{leak_points(*mesh, spheres), surface_of_leaks(*mesh, spheres)};
        found_here.link = part.link;
      }
    }
    if (!leaks.parts.empty()) found.push_back(std::move(leaks));
  }
  return found;
}

void place_leaks(std::vector<ViewItem>& items) {
  std::vector<const ViewItem*> sets;
  std::vector<ViewItem*> leaks;
  for (ViewItem& item : items) {
    if (is_sphere_set(item)) sets.push_back(&item);
    if (is_of_certificates(item)) leaks.push_back(&item);
  }
  if (sets.size() != leaks.size()) return;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    leaks[i]->of = sets[i]->name;
    for (ViewPart& part : leaks[i]->parts) add_surface(items, *sets[i], part);
  }
}

}  // namespace spherule
