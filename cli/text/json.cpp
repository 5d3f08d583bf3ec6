// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/json.h"

#include "cli/text/print.h"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <variant>

namespace spherule {
namespace {

// Escapes the control characters that JSON allows in texts but terminals obey: DEL and C1. Outside
// of texts there are none but line feeds, and JSON escapes C0 itself.
std::string without_controls(std::string_view json) {
  constexpr char kFirstOfC1 = '\xC2';  // of the two bytes, the second of which is the code point
  std::string result;
  result.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const bool is_of_two = json[i] == kFirstOfC1 && i + 1 < json.size();
    const unsigned code = static_cast<unsigned char>(json[is_of_two ? i + 1 : i]);
    if (is_control_character(code) && (is_of_two || code == 0x7FU)) {
      result.append("\\u00").append(hex(code));
      i += is_of_two ? 1 : 0;
    } else {
      result += json[i];
    }
  }
  return result;
}

}  // namespace

Json to_json(double value) {
  if (std::isfinite(value)) return value;
  return value > 0.0 ? "inf" : "-inf";
}

Json to_json(const Eigen::Vector3d& point) {
  return Json::array({to_json(point.x()), to_json(point.y()), to_json(point.z())});
}

Json to_json(const Eigen::AlignedBox3d& box) {
  return {{"min", to_json(Eigen::Vector3d(box.min()))},
          {"max", to_json(Eigen::Vector3d(box.max()))}};
}

Json to_json(const Bounds& bounds) {
  return Json::array({to_json(bounds.lower), to_json(bounds.upper)});
}

Json to_json(std::span<const Sphere> spheres) {
  Json list = Json::array();
  for (const Sphere& sphere : spheres) {
    list.push_back({{"center", to_json(sphere.center)}, {"radius", to_json(sphere.radius)}});
  }
  return list;
}

Json to_json(const std::map<std::string, OptionValue>& options) {
  struct Visitor {
    Json operator()(double value) const { return to_json(value); }
    Json operator()(bool value) const { return value; }
    Json operator()(std::int64_t value) const { return value; }
    Json operator()(const std::string& value) const { return value; }
  };
  Json object = Json::object();
  for (const auto& [name, value] : options) object[name] = std::visit(Visitor{}, value);
  return object;
}

Json to_json(const Certificate& certificate) {
  Json json = Json::object();
  json["covered"] = certificate.covered;
  json["uncovered_depth"] = to_json(certificate.uncovered_depth);
  json["uncovered_depth_surface"] = to_json(certificate.surface_depth);
  json["uncovered_depth_solid"] = to_json(certificate.solid_depth);
  json["deepest_leak"] =
      certificate.uncovered_depth.lower > 0.0 ? to_json(certificate.deepest_leak) : Json(nullptr);
  json["protrusion_over_simplified_max"] = to_json(certificate.protrusion_over_simplified_max);
  json["protrusion_over_mesh_max"] = certificate.protrusion_over_mesh
                                         ? to_json(certificate.protrusion_over_mesh->upper)
                                         : Json(nullptr);
  json["protrusion_over_mesh"] = to_json(certificate.protrusion_over_mesh);
  if (!certificate.protrusion_in_zones.empty()) json["zones"] = Json::array();
  for (const double protrusion : certificate.protrusion_in_zones) {
    json["zones"].push_back({{"protrusion_over_simplified_max", to_json(protrusion)}});
  }
  json["sphere_count"] = certificate.sphere_count;
  json["volume_ratio"] = to_json(certificate.volume_ratio);
  json["filled_volume"] = to_json(certificate.filled_volume);
  json["filled_volume_error"] = to_json(certificate.filled_volume_error);
  json["closing_slack"] = to_json(certificate.closing_slack);
  json["pieces"] = certificate.pieces;
  json["cells"] = certificate.cells;
  return json;
}

Json to_json(const ExternalSpheres& external, ReportContent content) {
  Json json = {{"box", to_json(external.box)},
               {"min_external_diameter", to_json(external.min_external_diameter)},
               {"padding", external.padding},
               {"grid_step", external.grid_step},
               {"closing_slack", to_json(external.closing_slack)},
               {"nodes_examined", external.nodes_examined},
               {"external_sphere_count", external.spheres.size()}};
  if (content == ReportContent::kAll) json["external_spheres"] = to_json(external.spheres);
  return json;
}

std::string to_text(const Json& json, Layout layout) {
  const int indent = layout == Layout::kIndented ? 2 : -1;
  return without_controls(json.dump(indent, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace spherule
