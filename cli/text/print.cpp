// SPDX-License-Identifier: BSD-3-Clause
#include "cli/text/print.h"

#include "cli/text/message.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <sstream>

namespace spherule {

std::string describe(const Certificate& certificate, const std::string& solid) {
  std::ostringstream out;
  out << "certificate: " << certificate.sphere_count << " spheres ";
  if (certificate.covered) {
    out << "cover " << solid << " (proved)\n";
  } else {
    const Bounds& depth = certificate.uncovered_depth;
    out << "are not proved to cover " << solid << "\n";
    out << "  leak: a point at a depth of " << depth.lower << ", none deeper than " << depth.upper
        << "\n";
    if (depth.lower > 0.0) {
      // All digits, so that the witness can be checked.
      const Eigen::Vector3d& leak = certificate.deepest_leak;
      out << std::setprecision(std::numeric_limits<double>::max_digits10) << "  deepest at ("
          << leak.x() << ", " << leak.y() << ", " << leak.z() << ")\n"
          << std::setprecision(6);
    }
  }
  if (certificate.protrusion_over_simplified_max) {
    out << "  protrusion over the simplified solid: at most "
        << *certificate.protrusion_over_simplified_max << "\n";
  }
  for (std::size_t i = 0; i < certificate.protrusion_in_zones.size(); ++i) {
    out << "  in zone " << i << ": at most " << certificate.protrusion_in_zones[i] << "\n";
  }
  if (certificate.protrusion_over_mesh) {
    out << "  protrusion over the mesh and its inside: " << certificate.protrusion_over_mesh->lower
        << " to " << certificate.protrusion_over_mesh->upper << "\n";
  }
  if (certificate.volume_ratio) {
    out << "  volume of the spheres over that of the mesh: about " << *certificate.volume_ratio
        << "\n";
  }
  if (certificate.filled_volume) {
    out << "  filled by stage 1: about " << *certificate.filled_volume << " (standard error "
        << *certificate.filled_volume_error << ") in volume\n";
  }
  return out.str();
}

std::string describe(std::span<const CoverLevel> levels) {
  std::ostringstream out;
  for (const CoverLevel& level : levels) {
    out << "level " << level.max_error << ": " << level.spheres.spheres.size()
        << " spheres, protrusion over the simplified solid at most " << level.protrusion
        << " (plain clustering: " << level.clustering_count << " spheres, "
        << level.clustering_protrusion << ")\n";
  }
  return out.str();
}

std::string percent(double share, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << 100.0 * share << " %";
  return out.str();
}

std::string three_digits(double value, Rounding rounding) {
  std::ostringstream text;
  if (value == 0.0 || !std::isfinite(value)) {
    text << value;
    return text.str();
  }
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  // A number of three digits is its own bound, however its decimals were rounded.
  constexpr double kSame = 1e-9;
  const double steps = value / step;
  const double whole = std::abs(steps - std::round(steps)) < kSame ? std::round(steps)
                       : rounding == Rounding::kUp                 ? std::ceil(steps)
                                                                   : std::floor(steps);
  text << std::setprecision(3) << whole * step;
  return text.str();
}

std::string aligned(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows) {
    for (std::string& cell : row) cell = one_line(cell);
  }
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] + 2 - row[i].size(), ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace spherule
