// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/result_warnings.h"

#include <optional>
#include <sstream>

namespace spherule {
namespace {

constexpr double kLargestVolume = 5.0;  // of the mesh's
// Of E: with the step that is usually chosen they are 0.02 E high.
constexpr double kLargestScallops = 0.025;

}  // namespace

std::string larger_diameter_warning(double min_external_diameter) {
  std::ostringstream text;
  text << "the part is so large for its max error that a min external diameter of "
       << min_external_diameter
       << " was chosen, instead of four times the max error: gaps that are narrower are filled; "
          "for a smaller one fit the part in pieces, or with a larger max error";
  return text.str();
}

std::vector<std::string> result_warnings(const Simplification& result) {
  std::vector<std::string> warnings;
  const ExternalSpheres& external = result.external;
  const double diameter = external.min_external_diameter;
  if (result.larger_diameter) warnings.push_back(larger_diameter_warning(diameter));
  const double step = external.grid_step;
  const double scallops = step > 0.0 ? step * step / (2.0 * diameter) : 0.0;
  if (scallops > kLargestScallops * result.options.max_error) {
    std::ostringstream text;
    text << "the part is so large that the grid of stage 1 has steps of " << step
         << ": what is covered has scallops up to " << scallops
         << " high along its walls, which takes some more spheres; a larger min external diameter, "
            "or the part in pieces, avoids that";
    warnings.push_back(text.str());
  }
  const std::optional<double>& ratio = result.certificate.volume_ratio;
  if (ratio && *ratio > kLargestVolume) {
    std::ostringstream text;
    text << "the spheres hold about " << *ratio << " times the volume of the mesh: the max error "
         << result.options.max_error;
    if (external.padding > result.options.max_error) {
      text << " or the padding " << external.padding;
    }
    text << " is coarse for it, or spaces are filled that a sphere of the min external diameter "
         << result.options.min_external_diameter
         << " cannot enter; if that is not wanted, choose less of one of them";
    warnings.push_back(text.str());
  }
  return warnings;
}

}  // namespace spherule
