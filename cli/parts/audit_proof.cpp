// SPDX-License-Identifier: BSD-3-Clause
#include "cli/parts/audit_proof.h"

#include "base/error.h"

#include <utility>

namespace spherule {

SolidProof::SolidProof(const TriangleMesh& mesh, const SimplifyOptions& options, bool has_diameter)
    : SolidProof(options, has_diameter ? std::optional(place_external_spheres(
                                             mesh, external_options(options)))
                                       : std::nullopt) {}

SolidProof::SolidProof(const SimplifyOptions& options, std::optional<ExternalSpheres> external)
    : external_(std::move(external)), zones_(options.zones) {
  options_.padding = options.padding;
  options_.threads = options.threads;
  options_.progress = options.progress;
  if (!external_) return;
  options_.external = &*external_;
  // A file that says how it was fitted was proved at this resolution.
  options_.resolution =
      proof_resolution(tightest_error(zones_, options.max_error), external_->box.diagonal().norm());
  options_.zones = zones_;
}

bool take_min_external(const std::optional<double>& min_external, SimplifyOptions& options) {
  if (!min_external) return false;
  options.min_external_diameter = *min_external;
  if (options.external == ExternalPlacement::kNone) {
    options.external = ExternalPlacement::kReachable;
  }
  return true;
}

void take_stored_unit(const std::string& spheres, const SphereFile& file,
                      const ModelReadOptions& stored, UnitArguments& unit) {
  if (!stored.units.empty() && !unit.units.empty() && stored.units != unit.units) {
    throw Error("--units",
                spheres + " is in " + unit_named(stored.units)->plural + ", as its options say");
  }
  if (unit.units.empty()) unit.units = stored.units;
  if (!unit.scale && file.options.contains("scale")) unit.scale = stored.scale;
}

}  // namespace spherule
