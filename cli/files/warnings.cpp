// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/warnings.h"

#include "cli/text/print.h"

#include <array>
#include <optional>
#include <span>

namespace spherule {
namespace {

constexpr double kLargestVolume = 5.0;  // of the mesh's
// Of E: with the step that is usually chosen they are 0.02 E high.
constexpr double kLargestScallops = 0.025;

// Of the largest extent of the part.
constexpr double kLargestError = 0.1;
constexpr double kSmallestError = 1e-3;
constexpr double kSmallestLikelyError = 1e-4;  // that units are guessed for
// Of E.
constexpr double kLeastDiameter = 0.1;

// A unit that lengths may have been meant in, and one that a mesh may be in instead.
struct UnitPair {
  const LengthUnit* meant;
  const LengthUnit* mesh;
  double factor() const { return meant->micrometres / mesh->micrometres; }
};

// The symbols of units that an error may have been meant in where it is too large or too small, and
// of those that the mesh may be in, the likeliest first.
struct UnitMixup {
  const char* meant;
  std::span<const char* const> meshes;
};
constexpr std::array kCoarseUnits = {"m", "inch", "cm"};
constexpr std::array kFineUnits = {"mm"};
constexpr UnitMixup kTooLarge{"mm", kCoarseUnits};
constexpr UnitMixup kTooSmall{"m", kFineUnits};

// The first with which the error would be one that people choose, of a part of this extent. The
// unit of the mesh may be known.
std::optional<UnitPair> likely_units(const UnitMixup& mixup, double error, double extent,
                                     const LengthUnit* known) {
  for (const char* symbol : mixup.meshes) {
    const UnitPair pair{unit_named(mixup.meant), unit_named(symbol)};
    if (known != nullptr && known != pair.mesh) continue;
    const double converted = error * pair.factor();
    if (converted <= kLargestError * extent && converted >= kSmallestLikelyError * extent) {
      return pair;
    }
  }
  return std::nullopt;
}

// What to do about an error in a unit that the mesh is not in; empty where none is likely.
std::string unit_advice(const UnitMixup& mixup, double error, double extent,
                        const ModelUnit& unit) {
  const LengthUnit* const known = unit.micrometres ? unit_of_size(*unit.micrometres) : nullptr;
  if (unit.micrometres && known == nullptr) return "";
  const std::optional<UnitPair> units = likely_units(mixup, error, extent, known);
  if (!units) return "";
  if (known != nullptr) {
    return concat(": both are in ", known->plural, " (", unit.origin,
                  "); if the error was meant in ", units->meant->plural, ", use --max-error ",
                  error, units->meant->symbol);
  }
  return concat(": if that is in ", units->mesh->plural, " and the error was meant in ",
                units->meant->plural, ", use --max-error ", error * units->factor(),
                ", or the same with --scale ", 1.0 / units->factor());
}

}  // namespace

std::string larger_diameter_warning(double min_external_diameter) {
  return concat("the part is so large for its max error that a min external diameter of ",
                min_external_diameter, " was chosen, instead of four times the max error: gaps ",
                "that are narrower are filled; for a smaller one fit the part in pieces, or with ",
                "a larger max error");
}

std::vector<std::string> result_warnings(const Simplification& result) {
  std::vector<std::string> warnings;
  const ExternalSpheres& external = result.external;
  const double diameter = external.min_external_diameter;
  if (result.larger_diameter) warnings.push_back(larger_diameter_warning(diameter));
  const double step = external.grid_step;
  const double scallops = step > 0.0 ? step * step / (2.0 * diameter) : 0.0;
  if (scallops > kLargestScallops * result.options.max_error) {
    warnings.push_back(concat(
        "the part is so large that the grid of stage 1 has steps of ", step,
        ": what is covered has scallops up to ", scallops, " high along its walls, which takes ",
        "some more spheres; a larger min external diameter, or the part in pieces, avoids that"));
  }
  const std::optional<double>& ratio = result.certificate.volume_ratio;
  if (ratio && *ratio > kLargestVolume) {
    const double error = result.options.max_error;
    warnings.push_back(concat(
        "the spheres hold about ", *ratio, " times the volume of the mesh: the max error ", error,
        external.padding > error ? concat(" or the padding ", external.padding) : "",
        " is coarse for it, or spaces are filled that a sphere of the min external diameter ",
        result.options.min_external_diameter,
        " cannot enter; if that is not wanted, choose less of one of them"));
  }
  return warnings;
}

std::vector<std::string> length_warnings(const MeshReport& mesh, const SimplifyOptions& options,
                                         const ModelUnit& unit) {
  std::vector<std::string> warnings;
  const double extent = mesh.box.isEmpty() ? 0.0 : mesh.box.sizes().maxCoeff();
  const double error = options.max_error;
  if (error > kLargestError * extent && extent > 0.0) {
    warnings.push_back(concat("the max error ", error, " is more than a tenth of the part, whose ",
                              "largest extent is ", extent,
                              unit_advice(kTooLarge, error, extent, unit)));
  } else if (error > 0.0 && error < kSmallestError * extent) {
    warnings.push_back(concat("the max error ", error, " is less than a thousandth of the part, ",
                              "whose largest extent is ", extent, ", which may take very many ",
                              "spheres and hours", unit_advice(kTooSmall, error, extent, unit)));
  }
  const double diameter = options.min_external_diameter;
  if (diameter > 0.0 && diameter < kLeastDiameter * error) {
    warnings.push_back(concat("the min external diameter ", diameter, " is less than a tenth of ",
                              "the max error ", error, ": nearly nothing is simplified away; are ",
                              "both in the same unit?"));
  }
  return warnings;
}

}  // namespace spherule
