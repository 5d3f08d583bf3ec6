// SPDX-License-Identifier: BSD-3-Clause
#include "cli/pages/view_files.h"

#include "base/error.h"
#include "base/files.h"
#include "cli/files/files.h"
#include "cli/files/model.h"
#include "cli/text/print.h"
#include "io/sphere_file.h"
#include "spheretree/tree_file.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <sstream>
#include <utility>
#include <variant>

namespace spherule {
namespace {

Eigen::Vector3d point_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

ViewItem leak_item(const Json& certificate, const std::string& file) {
  return {.name = leaks_name(file),
          .parts = {{ViewLeaks{leaks_of(certificate, file), {}}}},
          .facts = describe_cover(certificate)};
}

std::vector<ViewItem> report_items(const Json& report, const std::string& file) {
  std::vector<ViewItem> items;
  const Json& levels = report.at("levels");
  for (const Json& level : levels) {
    items.push_back(
        {.name = "level of E = " + three_digits(level.at("max_error").get<double>(), Rounding::kUp),
         .parts = {{spheres_of(level.at("spheres"), file)}},
         .shown = false});
  }
  const Json& solid = report.at("simplified_solid");
  if (const auto spheres = solid.find("external_spheres"); spheres != solid.end()) {
    items.push_back({.name = "external spheres",
                     .parts = {{spheres_of(*spheres, file)}},
                     .external = true,
                     .shown = false});
  }
  if (!report.at("certificate").at("covered").get<bool>()) {
    items.push_back(leak_item(report.at("certificate"), file));
  }
  return items;
}

// Only for showing: the proof is of the spheres in their own unit.
void show_in(const std::string& units, const std::string& stored, std::vector<Sphere>& spheres) {
  if (units.empty() || stored.empty() || units == stored) return;
  const double scale = in_units_of(unit_named(units)->micrometres, {1.0, unit_named(stored)});
  for (Sphere& sphere : spheres) sphere = {sphere.center * scale, sphere.radius * scale};
}

std::string facts_of(const SphereFile& file) {
  if (!file.certificate) return "";
  std::ostringstream text;
  text << (file.certificate->covered ? "covers (proved)" : "not proved to cover");
  if (const auto& protrusion = file.certificate->protrusion_over_simplified_max) {
    text << ", protrudes by at most " << three_digits(*protrusion, Rounding::kUp);
  }
  return text.str();
}

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

std::string leaks_name(const std::filesystem::path& file) {
  return "leaks: " + file.filename().string();
}

std::string describe_cover(const Json& certificate) {
  if (certificate.at("covered").get<bool>()) return "covered (proved)";
  const Json& depth = certificate.at("uncovered_depth");
  std::ostringstream text;
  if (depth.at(0).is_number() && depth.at(1).is_number()) {
    text << "the deepest is proved to be "
         << three_digits(depth.at(0).get<double>(), Rounding::kDown) << " to "
         << three_digits(depth.at(1).get<double>(), Rounding::kUp) << " deep";
  } else {
    text << "not proved to cover";
  }
  return text.str();
}

std::vector<Sphere> spheres_of(const Json& list, const std::string& file) {
  return blame_file<Json::exception>(file, [&] {
    std::vector<Sphere> spheres;
    for (const Json& entry : list) {
      const Sphere sphere{point_of(entry.at("center")), entry.at("radius").get<double>()};
      if (!is_usable(sphere)) throw Error(file, "holds a sphere that is not usable");
      spheres.push_back(sphere);
    }
    return spheres;
  });
}

std::vector<LeakPoint> leaks_of(const Json& certificate, const std::string& file) {
  return blame_file<Json::exception>(file, [&] {
    std::vector<LeakPoint> leaks;
    const Json& deepest = certificate.at("deepest_leak");
    const Json& depth = certificate.at("uncovered_depth").at(0);
    if (deepest.is_array() && depth.is_number()) {
      leaks.push_back({point_of(deepest), depth.get<double>()});
    }
    if (const auto more = certificate.find("leaks"); more != certificate.end()) {
      for (const Json& leak : *more) {
        leaks.push_back({point_of(leak.at("point")), leak.at("depth").get<double>()});
      }
    }
    return leaks;
  });
}

internal::JsonDocument<Json> json_in(const std::filesystem::path& file) {
  if (file.extension() != ".json") return internal::JsonDocument<Json>(nullptr);
  const auto refuse = [&](const std::string& reason) { throw Error(file.string(), reason); };
  return internal::parse_json<Json>(read_file(file), refuse);
}

std::vector<ViewItem> view_items(const std::string& file, const std::string& units) {
  const FileKind kind = recognize(file);
  if (kind == FileKind::kSpheres) {
    SphereFile spheres = load_spheres(file);
    const std::string facts = facts_of(spheres);
    show_in(units, stored_reading(spheres).units, spheres.spheres);
    return {{.name = file, .parts = {{std::move(spheres.spheres)}}, .facts = facts}};
  }
  if (kind == FileKind::kTree) return {{.name = file, .parts = {{load_tree(file)}}}};
  const internal::JsonDocument<Json> json = json_in(file);
  return blame_file<Json::exception>(file, [&]() -> std::vector<ViewItem> {
    if (json.is_object() && json.value("format", "") == "spherule-report") {
      return report_items(json, file);
    }
    if (json.is_object() && json.contains("deepest_leak")) return {leak_item(json, file)};
    const ModelUnit unit = model_unit(file, {std::nullopt, units});
    return {{.name = file, .parts = {{read_model(file, {.scale = unit.scale}).mesh}}}};
  });
}

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
