// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplification.h"

#include "simplifier/option_record.h"
#include "spheretree/build.h"

#include <cstddef>
#include <iomanip>
#include <optional>
#include <ostream>
#include <sstream>

namespace spherule {

std::string broken_promises(const Simplification& simplification) {
  const Certificate& certificate = simplification.certificate;
  const SimplifyOptions& options = simplification.options;
  std::ostringstream out;
  out << std::setprecision(12);
  if (!certificate.covered) out << "the spheres are not proved to cover";
  // A least radius may force spheres to protrude further.
  if (options.min_radius > 0.0) return out.str();
  const auto begin = [&](double most) -> std::ostream& {
    return out << (out.str().empty() ? "the spheres are not proved" : ", nor")
               << " to protrude by at most " << most;
  };
  const std::optional<double>& protrusion = certificate.protrusion_over_simplified_max;
  if (!protrusion || !(*protrusion <= options.max_error)) {
    begin(options.max_error) << " from the simplified solid";
    if (protrusion) out << ", only by at most " << *protrusion;
  }
  for (std::size_t i = 0; i < options.zones.size(); ++i) {
    const std::optional<double>& error = options.zones[i].max_error;
    if (!error) continue;
    const bool known = i < certificate.protrusion_in_zones.size();
    if (known && certificate.protrusion_in_zones[i] <= *error) continue;
    begin(*error) << " in zone " << i;
    if (known) out << ", only by at most " << certificate.protrusion_in_zones[i];
  }
  for (const CoverLevel& level : simplification.levels) {
    if (level.protrusion <= level.max_error) continue;
    begin(level.max_error) << " in a level, only by at most " << level.protrusion;
  }
  return out.str();
}

SphereTree sphere_tree(const Simplification& simplification) {
  const std::vector<Sphere>& spheres = simplification.cover.spheres;
  if (simplification.levels.empty()) return build_tree(spheres);
  return level_tree(spheres, simplification.levels).tree;
}

SphereFile sphere_file(const Simplification& simplification, double scale) {
  return {.spheres = simplification.cover.spheres,
          .certificate = record(simplification.certificate),
          .options = option_record(simplification.options, scale),
          .interrupted = simplification.interrupted};
}

}  // namespace spherule
