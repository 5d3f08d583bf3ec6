// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/json.h"

#include "cli/text/print.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>
#include <vector>

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

// Null where nothing stands there.
const Json& value_at(const Json& report, std::string_view path) {
  static const Json kNothing;
  const Json* value = &report;
  while (!path.empty()) {
    const std::string key(path.substr(0, path.find('.')));
    path.remove_prefix(std::min(path.size(), key.size() + 1));
    const Json::json_pointer here("/" + key);
    if (!value->contains(here)) return kNothing;
    value = &value->at(here);
  }
  return *value;
}

std::string shown(const Json& value, std::string_view format) {
  if (value.is_null()) return "-";
  if (value.is_boolean()) {
    const std::size_t bar = format.find('|');
    return std::string(value == true ? format.substr(0, bar) : format.substr(bar + 1));
  }
  if (value.is_string()) return one_line(value.get_ref<const std::string&>());
  if (format.ends_with('~')) {
    format.remove_suffix(1);
    return value[1] == 0.0 ? "0" : shown(value[0], format) + " to " + shown(value[1], format);
  }
  if (value.is_array()) {
    std::string list;
    for (const Json& one : value) list += (list.empty() ? "" : ", ") + shown(one, format);
    return list;
  }
  if (value.is_number_integer() && format.empty()) return value.dump();
  const double scale = format.starts_with("mm") ? kMillimetresPerMetre : 1.0;
  const double number = scale * value.get<double>();
  if (format == "mm") return number == 0.0 ? "0" : decimal(number, number < 0.1 ? 4 : 1);
  if (scale > 1.0) format.remove_prefix(2);
  const std::size_t at = format.find_first_of("0123456789");
  const int digits = at == format.npos ? 6 : std::stoi(std::string(format.substr(at)));
  if (format.starts_with('%')) return percent(number, digits);
  return format.starts_with('f') ? decimal(number, digits) : spherule::number(number, digits);
}

bool holds(const Json& report, std::string_view when) {
  if (when.starts_with('!')) return !holds(report, when.substr(1));
  if (when.starts_with('#')) return value_at(report, when.substr(1)) > 0.0;
  const Json& value = value_at(report, when);
  return value != false && value != "" && !value.empty();
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

Json to_json(const Repair& repair) {
  return {{"max_error", to_json(repair.max_error)},
          {"protrusion_before", to_json(repair.protrusion_before)},
          {"protrusion_after", to_json(repair.protrusion_after)},
          {"grown", repair.inflated},
          {"largest_inflation", to_json(repair.largest_inflation)},
          {"added", repair.added}};
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

std::string filled(std::string_view pattern, const Json& report) {
  std::string text;
  for (;;) {
    const std::size_t open = pattern.find('{');
    text += pattern.substr(0, open);
    if (open == pattern.npos) return text;
    const std::size_t close = pattern.find('}', open);
    const std::string_view place = pattern.substr(open + 1, close - open - 1);
    const std::size_t colon = std::min(place.find(':'), place.size());
    text += shown(value_at(report, place.substr(0, colon)),
                  place.substr(std::min(colon + 1, place.size())));
    pattern.remove_prefix(close + 1);
  }
}

std::string lines(const Json& report, std::initializer_list<Line> list) {
  std::string text;
  for (const Line& line : list) {
    if (!line.when.empty() && !holds(report, line.when)) continue;
    std::string pattern(line.pattern);
    const std::string_view path = line.when.substr(line.when.starts_with('#') ? 1 : 0);
    for (const char* here : {"{}", "{:"}) {
      for (std::size_t at = pattern.find(here); at != pattern.npos; at = pattern.find(here, at)) {
        pattern.insert(at + 1, path);
      }
    }
    text += filled(pattern, report);
  }
  return text;
}

std::string table(const Json& rows, std::initializer_list<Column> columns) {
  std::vector<std::vector<std::string>> cells(1);
  for (const Column& column : columns) cells.front().emplace_back(column.heading);
  if (columns.begin()->heading == std::string_view()) cells.clear();
  for (const Json& row : rows) {
    std::vector<std::string>& line = cells.emplace_back();
    for (const Column& column : columns) line.push_back(filled(column.pattern, row));
  }
  return aligned(std::move(cells));
}

std::string describe_certificate(const Json& certificate, const std::string& solid) {
  Json json = certificate;
  json["solid"] = solid;
  std::string text = lines(
      json,
      {{"covered", "certificate: {sphere_count} spheres cover {solid} (proved)\n"},
       {"!covered",
        "certificate: {sphere_count} spheres are not proved to cover {solid}\n"
        "  leak: a point at a depth of {uncovered_depth.0}, none deeper than "
        "{uncovered_depth.1}\n"},
       // All digits, so that the witness can be checked.
       {"deepest_leak", "  deepest at ({:17})\n"},
       {"protrusion_over_simplified_max", "  protrusion over the simplified solid: at most {}\n"}});
  for (std::size_t i = 0; i < value_at(json, "zones").size(); ++i) {
    text += "  in zone " + std::to_string(i) +
            filled(": at most {protrusion_over_simplified_max}\n", json["zones"][i]);
  }
  return text +
         lines(json, {{"protrusion_over_mesh",
                       "  protrusion over the mesh and its inside: {protrusion_over_mesh.0} to "
                       "{protrusion_over_mesh.1}\n"},
                      {"volume_ratio", "  volume of the spheres over that of the mesh: about {}\n"},
                      {"filled_volume",
                       "  filled by stage 1: about {} (standard error {filled_volume_error}) in "
                       "volume\n"}});
}

std::string describe_repair(const Json& repair, const std::string& format) {
  const auto length = [&](const std::string& key) { return "{" + key + ":" + format + "}"; };
  return filled("{grown} spheres inflated, by at most " + length("largest_inflation") +
                    ", and {added} added; these protrude by at most " + length("max_error") +
                    ", all by " + length("protrusion_after") +
                    " (before: " + length("protrusion_before") + ")",
                repair);
}

}  // namespace spherule
