// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/audit_robot_report.h"

#include "cli/text/message.h"
#include "cli/text/print.h"
#include "cli/text/units.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace spherule {
namespace {

std::string in_mm(double metres) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(metres * kMillimetresPerMetre < 0.1 ? 4 : 1)
      << metres * kMillimetresPerMetre;
  return metres == 0.0 ? "0" : out.str();
}

// "12.3 to 12.4", "0" where nothing is uncovered.
std::string in_mm(const Bounds& depth) {
  if (depth.upper == 0.0) return "0";
  return in_mm(depth.lower) + " to " + in_mm(depth.upper);
}

std::string in_mm(const Eigen::Vector3d& point) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(1);
  const auto put = [&](double metres) -> std::ostream& {
    constexpr double kDigit = 10.0;  // adding 0 makes a zero of -0
    return out << std::round(metres * kMillimetresPerMetre * kDigit) / kDigit + 0.0;
  };
  out << "(";
  put(point.x()) << ", ";
  put(point.y()) << ", ";
  put(point.z()) << ")";
  return out.str();
}

std::string yes(bool value) {
  return value ? "yes" : "NO";
}

// What was not certified, a line each.
void put_notes(std::ostream& out, const RobotAuditReport& report) {
  const RobotSpheres& spheres = report.file.spheres;
  if (spheres.switched_off > 0) {
    out << "left out: " << spheres.switched_off << " spheres that the file switches off\n";
  }
  if (spheres.other_shapes > 0) {
    out << "left out: " << spheres.other_shapes << " collision shapes that are no spheres\n";
  }
  for (const std::string& link : report.audit.unknown_links) {
    out << "left out: the spheres of " << one_line(link) << ", which is no link of the robot\n";
  }
}

void put_links(std::ostream& out, const std::vector<LinkAudit>& links) {
  std::size_t width = 4;
  for (const LinkAudit& link : links) width = std::max(width, one_line(link.link).size());
  const auto row = [&](const std::string& name, const std::string& spheres,
                       const std::string& surface, const std::string& inside,
                       const std::string& share, const std::string& protrusion,
                       const std::string& covered) {
    out << std::left << std::setw(static_cast<int>(width)) << one_line(name) << std::right
        << std::setw(8) << spheres << std::setw(18) << surface << std::setw(18) << inside
        << std::setw(11) << share << std::setw(18) << protrusion << std::setw(9) << covered << "\n";
  };
  row("link", "spheres", "leak surface", "leak inside", "uncovered", "protrusion", "covered");
  std::size_t spheres = 0;
  Bounds surface, inside, protrusion;
  bool covered = true;
  const auto worsen = [](Bounds& worst, const Bounds& other) {
    worst = {std::max(worst.lower, other.lower), std::max(worst.upper, other.upper)};
  };
  for (const LinkAudit& link : links) {
    if (!link.certificate) {
      if (link.spheres > 0) {
        row(link.link, std::to_string(link.spheres), "no geometry", "", "", "", "");
      }
      continue;
    }
    const Certificate& certificate = *link.certificate;
    std::ostringstream share;
    share << std::fixed << std::setprecision(1) << link.uncovered_share * 100.0 << " %";
    row(link.link, std::to_string(link.spheres), in_mm(certificate.surface_depth),
        in_mm(certificate.solid_depth), share.str(), in_mm(*certificate.protrusion_over_mesh),
        yes(certificate.covered));
    spheres += link.spheres;
    worsen(surface, certificate.surface_depth);
    worsen(inside, certificate.solid_depth);
    worsen(protrusion, *certificate.protrusion_over_mesh);
    covered = covered && certificate.covered;
  }
  row("all", std::to_string(spheres), in_mm(surface), in_mm(inside), "", in_mm(protrusion),
      yes(covered));
}

// Where the links leak; the columns have no room for it.
void put_places(std::ostream& out, const std::vector<LinkAudit>& links) {
  std::vector<std::vector<std::string>> rows;
  for (const LinkAudit& link : links) {
    if (!link.certificate || !(link.certificate->uncovered_depth.lower > 0.0)) continue;
    rows.push_back({"  " + link.link, in_mm(link.certificate->deepest_leak)});
  }
  if (rows.empty()) return;
  out << "deepest leaks at (x, y, z), in the frame of the link:\n" << aligned(rows);
}

void put_repair(std::ostream& out, const RobotAuditReport& report) {
  if (!report.repair) return;
  out << "repaired into " << one_line(report.repaired_file) << "\n";
  for (const LinkRepair& link : report.repair->links) {
    out << "  " << one_line(link.link) << ": " << link.repair.inflated
        << " spheres inflated, by at most " << in_mm(link.repair.largest_inflation) << ", and "
        << link.repair.added << " added; these protrude by at most " << in_mm(link.repair.max_error)
        << ", all by " << in_mm(link.repair.protrusion_after)
        << " (before: " << in_mm(link.repair.protrusion_before) << "); "
        << (link.certificate.covered ? "covered (proved)" : "NOT proved to cover") << "\n";
  }
}

Json json_of(const LinkAudit& link) {
  Json json = Json::object();
  json["link"] = link.link;
  json["sphere_count"] = link.spheres;
  json["uncovered_share"] = link.uncovered_share;
  json["certificate"] = link.certificate ? to_json(*link.certificate) : Json(nullptr);
  json["warnings"] = link.warnings;
  return json;
}

}  // namespace

std::string audit_table(const RobotAuditReport& report) {
  std::ostringstream out;
  out << name_of(report.file.format) << "; lengths in mm\n";
  put_links(out, report.audit.links);
  put_places(out, report.audit.links);
  put_notes(out, report);
  std::size_t number = 0;
  for (const ConfigurationAudit& configuration : report.audit.configurations) {
    out << "configuration " << ++number << ": ";
    if (configuration.uncovered_depth.upper == 0.0) {
      out << "all links are covered (proved)\n";
    } else {
      out << "leak " << in_mm(configuration.uncovered_depth) << ", at "
          << one_line(configuration.deepest_link);
      if (configuration.deepest_leak) {
        out << ", " << in_mm(*configuration.deepest_leak) << " in the frame of the root";
      }
      out << "\n";
    }
  }
  put_repair(out, report);
  if (report.pairs) out << describe(*report.pairs);
  return out.str();
}

Json audit_json(const RobotAuditReport& report) {
  Json json = Json::object();
  json["format"] = name_of(report.file.format);
  json["links_covered"] = report.audit.links_covered;
  json["links"] = Json::array();
  for (const LinkAudit& link : report.audit.links) json["links"].push_back(json_of(link));
  json["switched_off"] = report.file.spheres.switched_off;
  json["other_shapes"] = report.file.spheres.other_shapes;
  json["unknown_links"] = report.audit.unknown_links;
  if (!report.audit.configurations.empty()) {
    json["configurations_covered"] = report.audit.configurations_covered;
    json["configurations"] = Json::array();
    for (const ConfigurationAudit& configuration : report.audit.configurations) {
      json["configurations"].push_back({{"uncovered_depth", to_json(configuration.uncovered_depth)},
                                        {"deepest_link", configuration.deepest_link}});
      if (configuration.deepest_leak) {
        json["configurations"].back()["deepest_leak"] = to_json(*configuration.deepest_leak);
      }
    }
  }
  if (report.pairs) json.update(to_json(*report.pairs));
  if (!report.repair) return json;
  json["repair"] = {{"file", report.repaired_file}, {"links", Json::array()}};
  for (const LinkRepair& link : report.repair->links) {
    json["repair"]["links"].push_back(
        {{"link", link.link},
         {"max_error", to_json(link.repair.max_error)},
         {"protrusion_before", to_json(link.repair.protrusion_before)},
         {"protrusion_after", to_json(link.repair.protrusion_after)},
         {"grown", link.repair.inflated},
         {"largest_inflation", to_json(link.repair.largest_inflation)},
         {"added", link.repair.added},
         {"certificate", to_json(link.certificate)},
         {"warnings", link.warnings}});
  }
  return json;
}

}  // namespace spherule
