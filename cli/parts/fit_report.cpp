// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/fit_report.h"

#include "cli/text/json.h"

#include <sstream>

namespace spherule {
namespace {

Json to_json(const std::string& file, const TriangleMesh& mesh, const MeshReport& report) {
  return {{"file", file},
          {"vertices", report.vertices},
          {"triangles", report.triangles},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"boundary_edges", report.boundary_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"misoriented_edges", report.misoriented_edges},
          {"components", report.components},
          {"inverted_components", report.inverted_components},
          {"self_intersections", report.self_intersections},
          {"self_intersections_stopped", report.self_intersections_stopped},
          {"closed", report.closed},
          {"box", spherule::to_json(report.box)},
          {"area", report.area},
          {"volume", report.volume},
          {"vertex_error", mesh.vertex_error}};
}

Json to_json(const CoverHistoryEntry& entry) {
  return {{"sphere_count", entry.sphere_count},
          {"max_error", spherule::to_json(Bounds{.lower = entry.max_error_lower,
                                                 .upper = entry.max_error_upper})},
          {"surface_error_before", spherule::to_json(entry.surface_error_before)},
          {"surface_error_after", spherule::to_json(entry.surface_error_after)},
          {"coverage_before", entry.coverage_before},
          {"coverage_after", entry.coverage_after},
          {"excess_before", entry.excess_before},
          {"excess_after", entry.excess_after}};
}

Json to_json(const SphereCover& cover) {
  Json json = Json::object();
  json["lower_bound"] = cover.lower_bound > 0 ? Json(cover.lower_bound) : Json(nullptr);
  json["inflation"] = spherule::to_json(cover.inflation);
  json["seeds_rejected"] = cover.seeds_rejected;
  json["spheres_before_inflation"] = spherule::to_json(cover.spheres_before_inflation);
  json["history"] = Json::array();
  for (const CoverHistoryEntry& entry : cover.history) json["history"].push_back(to_json(entry));
  return json;
}

Json to_json(std::span<const CoverLevel> levels) {
  Json list = Json::array();
  for (const CoverLevel& level : levels) {
    list.push_back({{"max_error", level.max_error},
                    {"sphere_count", level.spheres.spheres.size()},
                    {"protrusion_over_simplified_max", level.protrusion},
                    {"clustering",
                     {{"sphere_count", level.clustering_count},
                      {"protrusion_over_simplified_max", level.clustering_protrusion}}},
                    {"parent_of_finer", level.spheres.parent_of},
                    {"spheres", spherule::to_json(level.spheres.spheres)}});
  }
  return list;
}

Json to_json(const CoverBreakdown& breakdown) {
  return {{"spheres_by_role",
           {{"edges", breakdown.edges},
            {"thin", breakdown.thin},
            {"faces", breakdown.faces},
            {"inside", breakdown.inside}}}};
}

}  // namespace

Json to_json(const FittedModel& model, const Simplification& result, ReportContent content) {
  Json json = Json::object();
  json["mesh"] = to_json(model.name, model.mesh, model.report);
  if (model.cad) json["cad"] = to_json(*model.cad);
  json["options"] = to_json(option_record(result.options, model.scale));
  json["seconds"] = {{"external", result.times.external},
                     {"cover", result.times.cover},
                     {"levels", result.times.levels},
                     {"certify", result.times.certify}};
  json["certificate"] = to_json(result.certificate);
  json["simplified_solid"] = to_json(result.external, content);
  json["cover"] = to_json(result.cover);
  json["levels"] = to_json(result.levels);
  if (result.interrupted) json["interrupted"] = true;
  return json;
}

std::string fit_report(const FittedModel& model, const ModelUnit& unit,
                       const Simplification& result, const CoverBreakdown& breakdown,
                       ReportContent content) {
  Json json = to_json(model, result, content);
  json["format"] = "spherule-report";
  json["version"] = 1;
  json["unit"] = to_json(unit);
  json["analysis"] = to_json(breakdown);
  // Indented, hundreds of thousands of external spheres would take three times the room.
  return to_text(json, Layout::kCompact);
}

std::string describe(const CoverBreakdown& breakdown) {
  std::ostringstream out;
  out << "where the spheres go: " << breakdown.edges << " along sharp edges, " << breakdown.thin
      << " in thin parts, " << breakdown.faces << " on faces, " << breakdown.inside << " inside\n";
  return out.str();
}

}  // namespace spherule
