// SPDX-License-Identifier: BSD-3-Clause
#include "cli/files/unit_warnings.h"

#include <optional>
#include <sstream>

namespace spherule {
namespace {

constexpr double kLargestError = 0.1;    // of the largest extent of the part
constexpr double kSmallestError = 1e-4;  // that units are guessed for
constexpr double kLeastDiameter = 0.1;   // of E

// A unit that lengths may have been meant in, and one that a mesh may be in instead.
struct UnitPair {
  const LengthUnit* meant;
  const LengthUnit* mesh;
  double factor() const { return meant->micrometres / mesh->micrometres; }
};

// The first with which the error would be one that people choose, of a part of this extent. The
// unit of the mesh may be known.
std::optional<UnitPair> likely_units(double error, double extent, const LengthUnit* known) {
  for (const char* symbol : {"m", "inch", "cm"}) {
    const UnitPair pair{unit_named("mm"), unit_named(symbol)};
    if (known != nullptr && known != pair.mesh) continue;
    const double converted = error * pair.factor();
    if (converted <= kLargestError * extent && converted >= kSmallestError * extent) return pair;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> length_warnings(const MeshReport& mesh, const SimplifyOptions& options,
                                         const ModelUnit& unit) {
  std::vector<std::string> warnings;
  const double extent = mesh.box.isEmpty() ? 0.0 : mesh.box.sizes().maxCoeff();
  const double error = options.max_error;
  if (error > kLargestError * extent && extent > 0.0) {
    std::ostringstream text;
    text << "the max error " << error
         << " is more than a tenth of the part, whose largest extent is " << extent;
    const LengthUnit* const known = unit.micrometres ? unit_of_size(*unit.micrometres) : nullptr;
    const std::optional<UnitPair> units =
        unit.micrometres && known == nullptr ? std::nullopt : likely_units(error, extent, known);
    if (units && known != nullptr) {
      text << ": both are in " << known->plural << " (" << unit.origin
           << "); if the error was meant in " << units->meant->plural << ", use --max-error "
           << error << units->meant->symbol;
    } else if (units) {
      text << ": if that is in " << units->mesh->plural << " and the error was meant in "
           << units->meant->plural << ", use --max-error " << error * units->factor()
           << ", or for --scale " << 1.0 / units->factor();
    }
    warnings.push_back(text.str());
  }
  const double diameter = options.min_external_diameter;
  if (diameter > 0.0 && diameter < kLeastDiameter * error) {
    std::ostringstream text;
    text << "the min external diameter " << diameter << " is less than a tenth of the max error "
         << error << ": nearly nothing is simplified away; are both in the same unit?";
    warnings.push_back(text.str());
  }
  return warnings;
}

}  // namespace spherule
