// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/robot_report.h"

#include "cli/files/result_warnings.h"
#include "cli/options/robot_options.h"
#include "cli/text/message.h"
#include "cli/text/units.h"

#include <algorithm>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <optional>
#include <span>
#include <sstream>

namespace spherule {
namespace {

// Over all links.
struct Totals {
  explicit Totals(std::span<const LinkCover> all) {
    for (const LinkCover& link : all) {
      if (!link.fit) continue;
      const Certificate& certificate = link.fit->certificate;
      ++links;
      triangles += link.triangles;
      spheres += link.spheres.size();
      covered = covered && certificate.covered;
      depth = std::max(depth, certificate.uncovered_depth.upper);
      protrusion = std::max(protrusion, certificate.protrusion_over_simplified_max.value_or(0.0));
      over_mesh = std::max(over_mesh, certificate.protrusion_over_mesh->upper);
    }
  }

  std::size_t links = 0;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  bool covered = true;
  double depth = 0.0;
  double protrusion = 0.0;
  double over_mesh = 0.0;
};

const std::string& name_of(LinkGeometry geometry) {
  static const std::vector<std::string> names = geometry_names();
  return names[geometry == LinkGeometry::kCollision ? 0 : 1];
}

Json summary_of(const LinkCover& link) {
  Json json = Json::object();
  json["link"] = link.link;
  json["sphere_count"] = link.spheres.size();
  if (!link.fit) return json;
  const Simplification& fit = *link.fit;
  json["triangles"] = link.triangles;
  json["vertex_error"] = link.vertex_error;
  json["options"] = to_json(option_record(fit.options, 1.0));
  json["certificate"] = to_json(fit.certificate);
  json["warnings"] = link.warnings;
  if (fit.interrupted) json["interrupted"] = true;
  json["seconds"] = {{"external", fit.times.external},
                     {"cover", fit.times.cover},
                     {"certify", fit.times.certify},
                     {"total", link.seconds}};
  return json;
}

// A number of the table, blanks before it.
class Cell {
 public:
  Cell(double value, int width, int digits) : value_(value), width_(width), digits_(digits) {}

  friend std::ostream& operator<<(std::ostream& out, const Cell& cell) {
    return out << std::fixed << std::setprecision(cell.digits_) << std::setw(cell.width_)
               << cell.value_;
  }

 private:
  double value_;
  int width_;
  int digits_;
};

// A depth that is proved to be none is shown as a bare 0; no other is.
std::string depth_text(bool covered, double depth) {
  if (covered) return "0";
  std::ostringstream out;
  out << std::setprecision(3) << depth * kMillimetresPerMetre;
  return out.str();
}

void write_row(std::ostream& out, const std::string& name, double max_error, const Totals& sums) {
  out << name << Cell(max_error * kMillimetresPerMetre, 8, 1) << std::setw(11) << sums.triangles
      << std::setw(9) << sums.spheres << std::setw(11) << depth_text(sums.covered, sums.depth)
      << Cell(sums.protrusion * kMillimetresPerMetre, 12, 2)
      << Cell(sums.over_mesh * kMillimetresPerMetre, 11, 2);
}

constexpr double kLitresPerCubicMetre = 1e3;
constexpr double kLargestRatio = 1e4;

// D of the links, and how much wider a way may be and still be filled.
std::string describe_filling(const RobotCover& cover) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double least = kNone;
  double most = 0.0;
  double slack = 0.0;
  for (const LinkCover& link : cover.links) {
    if (!link.fit) continue;
    const ExternalSpheres& external = link.fit->external;
    least = std::min(least, external.min_external_diameter);
    most = std::max(most, external.min_external_diameter);
    slack = std::max(slack, external.closing_slack / external.min_external_diameter);
  }
  if (least == kNone) return {};
  std::ostringstream out;
  out << "filled: what is narrower than D = " << Cell(least * kMillimetresPerMetre, 0, 1);
  if (most > least) out << " to " << Cell(most * kMillimetresPerMetre, 0, 1);
  out << " mm (a smaller --min-external fills less); ways that are wider by "
      << Cell(100.0 * slack, 0, 1) << " % stay open (proved)\n";
  return out.str();
}

}  // namespace

Json robot_summary(const std::string& urdf, const RobotCover& cover, double seconds) {
  const Totals totals(cover.links);
  Json json = Json::object();
  json["format"] = "spherule-robot-report";
  json["version"] = 1;
  json["urdf"] = urdf;
  json["robot"] = cover.robot;
  json["geometry"] = name_of(cover.options.geometry);
  json["total"] = {{"links", totals.links},
                   {"triangles", totals.triangles},
                   {"sphere_count", totals.spheres},
                   {"covered", totals.covered},
                   {"uncovered_depth_max", to_json(totals.depth)},
                   {"protrusion_over_simplified_max", to_json(totals.protrusion)},
                   {"protrusion_over_mesh_max", to_json(totals.over_mesh)},
                   {"not_proved", links_not_proved(cover)},
                   {"seconds", seconds}};
  json["links"] = Json::array();
  for (const LinkCover& link : cover.links) json["links"].push_back(summary_of(link));
  return json;
}

Json robot_report(const Json& summary, const RobotCover& cover, ReportContent content) {
  Json json = summary;
  for (std::size_t i = 0; i < cover.links.size(); ++i) {
    if (!cover.links[i].fit) continue;
    json["links"][i]["simplified_solid"] = to_json(cover.links[i].fit->external, content);
  }
  return json;
}

std::string robot_table(const RobotCover& cover, double seconds) {
  std::size_t width = 5;  // of "total"
  for (const LinkCover& link : cover.links) width = std::max(width, one_line(link.link).size());
  const auto padded = [&](std::string name) {
    name.resize(width, ' ');
    return name;
  };
  std::ostringstream out;
  out << padded("link")
      << "       E  triangles  spheres  uncovered  protrusion  over mesh  volume   filled  "
         "seconds\n"
      << padded("")
      << "    [mm]                           [mm]        [mm]       [mm]            [l]\n";
  for (const LinkCover& link : cover.links) {
    if (!link.fit) {
      out << padded(one_line(link.link)) << "  no " << name_of(cover.options.geometry)
          << " geometry\n";
      continue;
    }
    write_row(out, padded(one_line(link.link)), link.fit->options.max_error, Totals({&link, 1}));
    const std::optional<double>& volume = link.fit->certificate.volume_ratio;
    if (volume && *volume > kLargestRatio) {  // next to none in the mesh
      out << std::setw(8) << "> 1e4";
    } else if (volume) {
      out << Cell(*volume, 8, 2);
    } else {  // an open mesh has none
      out << std::setw(8) << "-";
    }
    const std::optional<double>& filled = link.fit->certificate.filled_volume;
    if (filled) {
      out << Cell(*filled * kLitresPerCubicMetre, 9, 3);
    } else {
      out << std::setw(9) << "-";
    }
    out << Cell(link.seconds, 9, 1) << (link.fit->interrupted ? " *" : "") << "\n";
  }
  write_row(out, padded("total"), cover.options.max_error, Totals(cover.links));
  out << std::setw(17) << "" << Cell(seconds, 9, 1) << "\n";
  if (!links_interrupted(cover).empty()) out << "* " << kInterruptedSearch << "\n";
  out << describe_filling(cover);
  return out.str();
}

}  // namespace spherule
